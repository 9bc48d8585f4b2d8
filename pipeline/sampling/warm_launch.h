// Leaves in a device's caches what launches touch that are not timed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <memory>

#include "memsys/memory_system.h"
#include "pipeline/device.h"
#include "pipeline/sampling/launch_traces.h"

namespace glint::pipeline {

// Lets the L2 of a device hold the lines that launches touch, on top of what launches before them have left,
// or, with cold caches, of nothing. It keeps the device's caches until give_back(), because making a memory
// system for each of many small launches takes longer than they do. Model: lines that a launch writes are
// written back by later launches, and never by itself.
class WarmCaches {
 public:
  // `device` outlives this object, and runs nothing before give_back().
  WarmCaches(const GpuParams& gpu, Device& device) : gpu_(gpu), device_(device) {}

  // Runs a launch on the functional machine. The result has counts and no statistics. A launch that the watch
  // stops leaves empty caches. Throws as run_functional() does.
  RenderResult run(const exec::World& world, Caches caches, const LaunchWatch& watch);
  // Does the same to memory and to the L2 from the trace of the launch, without running it.
  void replay(const LaunchTraces& traces, size_t launch, const exec::World& world, Caches caches);
  // Gives the device its caches back, if they were taken.
  void give_back();

 private:
  // A memory system that nothing else uses, with statistics that nobody reads.
  struct Unread {
    explicit Unread(const GpuParams& gpu) : memory(gpu.memory, gpu.cores, gpu.clock_mhz, &group) {}
    stats::Group group{nullptr, "gpu"};
    mem::MemorySystem memory;
  };
  mem::MemorySystem& taken(Caches caches);

  const GpuParams& gpu_;
  Device& device_;
  std::unique_ptr<Unread> held_;
};

}  // namespace glint::pipeline
