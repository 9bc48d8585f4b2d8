// Puts a compiled kernel into simulated memory: places its variables and sets its parameters and its grid.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exec/image.h"
#include "frontend/ptx/ptx.h"
#include "frontend/virtual_program.h"
#include "pipeline/params.h"
#include "pipeline/render.h"

namespace glint::pipeline {

struct KernelGrid {
  std::array<uint32_t, 3> grid{1, 1, 1}, block{1, 1, 1};
  uint32_t dynamic_shared_bytes = 0;
  // Bytes of a thread's stack for the functions that the kernel calls. Nothing: kDefaultStackBytes.
  std::optional<uint32_t> stack_bytes = {};
};

// Choice: CUDA's default (cudaLimitStackSize) is 1 KB. Frames are larger here, because the caller saves all
// registers, and lie beside the kernel's own frame.
inline constexpr uint32_t kDefaultStackBytes = 8192;
inline constexpr uint32_t kMostStackBytes = frontend::kMostLocalBytes;

// Returns how a machine's parameters have a kernel compiled. `contract` fuses products into sums.
frontend::PtxOptions ptx_options(const CompilerParams& compiler, bool contract = true);

// Holds the addresses of a module's variables in global memory, by name.
using ModuleVariables = std::map<std::string, Address>;

// Holds memory and world of a kernel. It cannot be moved, because `world` points into it.
class KernelWorld {
 public:
  // Links the kernel and puts its module's variables into `memory`, which several kernels may share. Kernels
  // of one module also share `variables`, those that are there already; with null the kernel has its own.
  explicit KernelWorld(frontend::Kernel kernel,
                       std::shared_ptr<mem::AddressSpace> memory = std::make_shared<mem::AddressSpace>(),
                       ModuleVariables* variables = nullptr);
  KernelWorld(const KernelWorld&) = delete;
  KernelWorld& operator=(const KernelWorld&) = delete;

  exec::World world;  // ready after set_grid and set_arguments
  exec::Image image;
  mem::AddressSpace& memory() { return *memory_; }
  const frontend::Kernel& kernel() const { return kernel_; }

  // Sets the grid. Throws UserError when the kernel cannot run with blocks of that size.
  void set_grid(const KernelGrid& grid);
  // Sets the bytes of each parameter, in order. Their sizes must be those of the parameters.
  void set_arguments(const std::vector<std::vector<std::byte>>& arguments);
  // Returns the bytes of an argument: a number or an address.
  template <class T>
  static std::vector<std::byte> argument(T value) {
    std::vector<std::byte> out(sizeof value);
    std::memcpy(out.data(), &value, sizeof value);
    return out;
  }

 private:
  void place_variables(ModuleVariables& placed);
  void set_stack(std::optional<uint32_t> bytes);

  frontend::Kernel kernel_;
  std::shared_ptr<mem::AddressSpace> memory_;
};

}  // namespace glint::pipeline
