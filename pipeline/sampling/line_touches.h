// Turns what blocks access into lines, for the L2 of a timing machine.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "core/coalesce.h"
#include "exec/executor.h"
#include "memsys/memory_system.h"
#include "pipeline/block_runner.h"

namespace glint::pipeline {

// Says what the L2 makes of lines that blocks write.
enum class Written : uint8_t {
  AsRead,     // They count as read, because other blocks pay for writing them back.
  StaysDirty  // Whoever needs their places writes them back.
};

// Model: what blocks touch goes through a filter of as many lines as an L1 has in place of the L1s of their
// cores. Accesses to stacks and shared memory are left out.
class LineTouches {
 public:
  // Takes sectors of a line, and returns how many others it has lost (MemorySystem::warm()).
  using Sink = std::function<uint32_t(Address line, uint8_t sectors, mem::Touch touch)>;

  // `world` outlives this object. `params` are those of the memory.
  LineTouches(const exec::World& world, const mem::Params& params, Sink sink, Written written);
  LineTouches(const LineTouches&) = delete;  // Those that it listens to know where it is.
  LineTouches& operator=(const LineTouches&) = delete;

  // Hears of all that the executor does from now on. It must not run any more when this object ends.
  void listen_to(exec::Executor& executor);
  // Tells, from now on, which chunks of global memory are written, by virtual addresses. A chunk may be told
  // more than once.
  static constexpr uint32_t kChunkShift = 8;  // Choice: a chunk has 256 bytes.
  using Writes = std::function<void(Address chunk)>;
  void tell_writes(Writes writes) { writes_ = std::move(writes); }
  // Returns what hears of the nodes that rays visit.
  const BlockRunner::NodeListener& nodes() const { return nodes_; }
  // Forgets what was handed on, so that the sink hears of all lines again.
  void forget() { recent_.assign(recent_.size(), Recent{}); }
  // Returns how many sectors made way that DRAM had not got yet.
  uint64_t lost_sectors() const { return lost_; }

 private:
  void touch(const exec::Executor& executor, const exec::Retired& retired);
  void tell_write(Address first, uint32_t bytes, Address& last) const;
  void touch_bytes(Address physical, uint32_t bytes);
  void touch_line(Address line, uint8_t sectors, mem::Touch touch);

  const exec::World& world_;
  const uint32_t line_shift_;  // a line has 1 << line_shift_ bytes
  const Written written_;
  const Sink sink_;
  Writes writes_;
  const BlockRunner::NodeListener nodes_;
  core::LineList lines_;
  struct Recent {
    Address line = ~Address{0};
    uint8_t sectors = 0, written = 0;
  };
  std::vector<Recent> recent_;  // direct-mapped; their number is a power of two
  uint64_t lost_ = 0;
};

}  // namespace glint::pipeline
