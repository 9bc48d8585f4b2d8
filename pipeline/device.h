// Takes one launch after another on one GPU, and keeps its caches warm between them where that is wanted.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>
#include <utility>

#include "core/cost_recorder.h"
#include "memsys/memory_system.h"
#include "pipeline/render.h"

namespace glint::pipeline {

// Says what a timed launch finds in the L2 and in the row buffers of DRAM: nothing, or what the timed launch
// before it has left there.
enum class Caches : uint8_t { Cold, Warm };

struct LaunchMode {
  bool timing = true;    // false: the functional machine
  bool no_skip = false;  // simulates every cycle
  uint32_t threads = 1;  // threads of the host (HostOptions)
  Caches caches = Caches::Cold;
  Observation observe;  // what else to note of a timing run
};

struct FunctionalCounts;

// Returns the result of a functional run, without its time.
RenderResult functional_result(const FunctionalCounts& counts, const exec::World& world);

// Every launch has statistics of its own, which RenderResult::add() sums up. A launch gives back the memory
// that the machine reserved for it, so a cold launch has the cycles that it has alone with the same memory.
// Model: between launches nothing happens to the L2 and to DRAM; what a host writes there does not pass
// through them. A launch that was ended early, that failed or that ran functionally leaves no warm caches
// behind it, or those of before, if it was functional.
class Device {
 public:
  explicit Device(const GpuParams& gpu) : gpu_(gpu) {}

  // Runs a launch to its end, or until the watch ends it. The result has everything except pictures,
  // structures and warnings. Throws as render() does.
  RenderResult run(const exec::World& world, const LaunchMode& mode, const LaunchWatch& watch);
  // Empties the caches.
  void cool() { contents_.clear(); }
  // Takes what the last timed launch has left, and gives the next one something else to find.
  mem::MemoryContents take_contents() { return std::exchange(contents_, {}); }
  void put_contents(mem::MemoryContents&& contents) { contents_ = std::move(contents); }

 private:
  void run_timed(const exec::World& world, const LaunchMode& mode, const LaunchWatch& watch,
                 core::LaunchCosts* costs, RenderResult& result);

  const GpuParams gpu_;
  mem::MemoryContents contents_;  // what the last timed launch has left; empty when the caches are cold
};

}  // namespace glint::pipeline
