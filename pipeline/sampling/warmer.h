// Runs blocks functionally, and hands on what they touch, for the L2 of a timing machine.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/endless_loops.h"
#include "exec/executor.h"
#include "pipeline/block_runner.h"
#include "pipeline/sampling/line_touches.h"

namespace glint::pipeline {

class Warmer {
 public:
  // `world` outlives the warmer. `params` are those of the memory.
  Warmer(const exec::World& world, uint64_t instruction_budget, const mem::Params& params,
         LineTouches::Sink sink, Written written);

  // Runs block `index` and returns what it did. Throws Error(Exit::Fault) as run_functional()
  // does.
  WorkCounts run(uint32_t index);
  // Lets blocks leave what they do to memory in `memory`, which may be null.
  void use(exec::BlockMemory* memory) { executor_.use(memory); }
  // Forgets what was handed on, so that the sink hears of all lines of the next block.
  void forget() { touches_.forget(); }
  const exec::FaultLog& passed() const { return executor_.passed(); }  // faults that were let pass
  // Returns how many sectors made way that DRAM had not got yet.
  uint64_t lost_sectors() const { return touches_.lost_sectors(); }

 private:
  LineTouches touches_;
  exec::Executor executor_;
  const exec::EndlessLoops endless_;
  BlockRunner runner_;
};

}  // namespace glint::pipeline
