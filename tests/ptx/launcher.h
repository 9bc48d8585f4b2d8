// Runs kernels from PTX text on either machine, with buffers on the host's side, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/functional_machine.h"
#include "pipeline/kernel_launch.h"
#include "pipeline/timing_machine.h"

namespace glint {

// Holds one kernel with its buffers and arguments, in order.
class Launcher {
 public:
  Launcher(const std::string& text, const std::string& file, const std::string& entry,
           const frontend::PtxOptions& options = {})
      : world_(frontend::compile_ptx(text, file, entry, options)) {}

  template <class T>
  Launcher& buffer(const std::vector<T>& data) {
    buffers_.push_back(
        world_.memory().allocate("argument " + std::to_string(arguments_.size()), data.size() * sizeof(T)));
    world_.memory().write(buffers_.back(), data.data(), data.size() * sizeof(T));
    return value(buffers_.back());
  }
  template <class T>
  Launcher& value(T value) {
    arguments_.push_back(pipeline::KernelWorld::argument(value));
    return *this;
  }

  void run_functional(const pipeline::KernelGrid& grid, uint32_t threads = 1) {
    prepare(grid);
    pipeline::run_functional(world_.world, 1'000'000'000, {}, {}, nullptr, threads);
  }
  Cycle run_timing(const pipeline::KernelGrid& grid, const pipeline::GpuParams& params,
                   uint32_t threads = 1) {
    prepare(grid);
    pipeline::HostOptions host;
    host.threads = threads;
    return pipeline::TimingMachine(params, world_.world, false, host).run({});
  }

  // Returns the contents of buffer `n`, counted among the buffers.
  template <class T>
  std::vector<T> read(size_t n, size_t count) {
    const auto view = world_.memory().view<T>(buffers_.at(n), count);
    return {view.begin(), view.end()};
  }
  pipeline::KernelWorld& world() { return world_; }
  void set_arguments() { world_.set_arguments(arguments_); }

 private:
  void prepare(const pipeline::KernelGrid& grid) {
    world_.set_grid(grid);
    world_.set_arguments(arguments_);
  }

  pipeline::KernelWorld world_;
  std::vector<std::vector<std::byte>> arguments_;
  std::vector<Address> buffers_;
};

}  // namespace glint
