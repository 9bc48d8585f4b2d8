// Keeps what launches have done to memory and to the caches, so that it can be done again without running
// them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "memsys/memory_system.h"
#include "pipeline/functional_machine.h"
#include "pipeline/params.h"

namespace glint::pipeline {

// Choice: so many bytes of the host are taken for traces. A launch whose trace has no room has none.
inline constexpr uint64_t kMostTraceBytes = uint64_t{1} << 30;

class LaunchTraces {
 public:
  explicit LaunchTraces(uint64_t most_bytes = kMostTraceBytes) : most_bytes_(most_bytes) {}

  // Runs the next launch functionally on one thread. Its trace is kept when it has run to its end.
  FunctionalCounts record(const exec::World& world, const GpuParams& gpu, const LaunchWatch& watch);

  // Says whether there is the trace of a launch, the first one being number 0.
  bool has(size_t launch) const { return launch < traces_.size() && traces_[launch].is_whole; }
  // Gives memory the bytes that the launch has left there, and hands its lines to the caches. The memory is
  // as it was before the launch, and so is everything if all launches before it have run or were replayed.
  void replay(size_t launch, mem::AddressSpace& memory, mem::MemorySystem& caches) const;
  void drop(size_t launch);
  uint64_t bytes() const { return bytes_; }  // of the host, of all traces

 private:
  struct Trace {
    std::vector<uint64_t> touches;   // lines, their sectors, and whether they were written (packed())
    std::vector<Address> chunks;     // of memory that were written, ascending
    std::vector<std::byte> written;  // their bytes, one chunk after the other
    bool is_whole = false;
    uint64_t bytes() const {
      return touches.capacity() * sizeof(uint64_t) + chunks.capacity() * sizeof(Address) + written.capacity();
    }
  };
  class Recorder;

  const uint64_t most_bytes_;
  uint64_t bytes_ = 0;
  std::vector<Trace> traces_;
};

}  // namespace glint::pipeline
