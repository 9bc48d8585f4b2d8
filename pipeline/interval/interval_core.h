// Holds the state of a core in the interval model.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

#include "core/coalesce.h"
#include "core/core_cell.h"
#include "core/residency.h"
#include "pipeline/interval/interval_machine.h"

namespace glint::pipeline {

struct IntervalMachine::Core {
  // Holds what a warp slot keeps between the intervals of its warp.
  struct Warp {
    exec::WarpContext context;
    std::array<Cycle, core::kScoreboardEntries> ready{};  // cycles in which registers are ready
    bool waits = false;                                   // at a barrier
    Cycle arrived = 0;                                    // when it came there
    Cycle copied = 0;                                     // when the last of its asynchronous copies is done
  };
  Core(const GpuParams& params, const exec::World& world, MemoryModel& memory, uint32_t core_index,
       const core::Residency& residency, Address locals)
      : index(core_index),
        rays(params.rt, *world.memory, memory, core_index),
        warps(residency.warps),
        blocks(residency.blocks),
        left(residency.blocks),
        issue(params.core.schedulers),
        lines(params.memory.line),
        local(core::CoreCell::local_layout(params.core, world, locals)) {}

  uint32_t index;
  RayModel rays;
  std::vector<Warp> warps;          // indexed by slot: those of a block lie one after another
  std::vector<exec::Block> blocks;  // indexed by place
  std::vector<uint32_t> left;       // warps of each block that have not ended
  std::vector<Cycle> issue;         // cycle in which each scheduler has issued all that it was given
  Bandwidth lsu, shared, door;      // accesses, passes of shared memory, sectors to or from the L1
  Cycle held_until = 0;             // The L1 takes nothing before, because its miss queue is full.
  Cycle barrier = 0;                // cycle in which the barrier unit is free
  double issue_work = 0;
  core::LineList lines;
  core::LocalLayout local;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events;
};

}  // namespace glint::pipeline
