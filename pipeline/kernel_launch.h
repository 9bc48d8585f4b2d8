// A compiled kernel in simulated memory: its variables placed, its parameters set, its grid of blocks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

#include "exec/image.h"
#include "frontend/ptx/ptx.h"
#include "pipeline/render.h"

namespace glint::pipeline {

struct KernelGrid {
  std::array<uint32_t, 3> grid{1, 1, 1}, block{1, 1, 1};
  uint32_t dynamic_shared_bytes = 0;
};

// Memory and world of a kernel. Not movable: `world` points into it.
class KernelWorld {
 public:
  // Links the kernel and puts its module's variables into memory.
  explicit KernelWorld(frontend::Kernel kernel);
  KernelWorld(const KernelWorld&) = delete;
  KernelWorld& operator=(const KernelWorld&) = delete;

  exec::World world;  // ready after set_grid and set_arguments
  exec::Image image;
  mem::AddressSpace& memory() { return memory_; }
  const frontend::Kernel& kernel() const { return kernel_; }

  // UserError when the kernel cannot run with blocks of that size.
  void set_grid(const KernelGrid& grid);
  // The bytes of each parameter, in order; their sizes must be the parameters'.
  void set_arguments(const std::vector<std::vector<std::byte>>& arguments);
  // Bytes of an argument: numbers and addresses.
  template <class T>
  static std::vector<std::byte> argument(T value) {
    std::vector<std::byte> out(sizeof value);
    std::memcpy(out.data(), &value, sizeof value);
    return out;
  }

 private:
  void place_variables();

  frontend::Kernel kernel_;
  mem::AddressSpace memory_;
};

}  // namespace glint::pipeline
