// Puts a compiled kernel into simulated memory: places its variables and sets its parameters and its grid.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "exec/image.h"
#include "frontend/ptx/ptx.h"
#include "pipeline/params.h"
#include "pipeline/render.h"

namespace glint::pipeline {

struct KernelGrid {
  std::array<uint32_t, 3> grid{1, 1, 1}, block{1, 1, 1};
  uint32_t dynamic_shared_bytes = 0;
};

// Returns how a machine's parameters have a kernel compiled. `contract` fuses products into sums.
frontend::PtxOptions ptx_options(const CompilerParams& compiler, bool contract = true);

// Holds memory and world of a kernel. It cannot be moved, because `world` points into it.
class KernelWorld {
 public:
  // Links the kernel and puts its module's variables into `memory`, which several kernels may share.
  explicit KernelWorld(frontend::Kernel kernel,
                       std::shared_ptr<mem::AddressSpace> memory = std::make_shared<mem::AddressSpace>());
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
  void place_variables();

  frontend::Kernel kernel_;
  std::shared_ptr<mem::AddressSpace> memory_;
};

}  // namespace glint::pipeline
