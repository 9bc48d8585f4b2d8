// Runs blocks functionally, and hands on what they touch, for the L2 of a timing machine.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "core/coalesce.h"
#include "exec/endless_loops.h"
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
class Warmer {
 public:
  // Takes sectors of a line, and returns how many others it has lost (MemorySystem::warm()).
  using Sink = std::function<uint32_t(Address line, uint8_t sectors, mem::Touch touch)>;

  // `world` outlives the warmer. `params` are those of the memory.
  Warmer(const exec::World& world, uint64_t instruction_budget, const mem::Params& params, Sink sink,
         Written written);

  // Runs block `index` and returns what it did. Throws Error(Exit::Fault) as run_functional()
  // does.
  WorkCounts run(uint32_t index);
  // Forgets what was handed on, so that the sink hears of all lines of the next block.
  void forget() { recent_.assign(recent_.size(), Recent{}); }
  const exec::FaultLog& passed() const { return executor_.passed(); }  // faults that were let pass
  // Returns how many sectors made way that DRAM had not got yet.
  uint64_t lost_sectors() const { return lost_; }

 private:
  void touch(const exec::Retired& retired);
  void touch_bytes(Address physical, uint32_t bytes);
  void touch_line(Address line, uint8_t sectors, mem::Touch touch);

  const exec::World& world_;
  const uint32_t line_shift_;  // a line has 1 << line_shift_ bytes
  const Written written_;
  const Sink sink_;
  exec::Executor executor_;
  const exec::EndlessLoops endless_;
  BlockRunner runner_;
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
