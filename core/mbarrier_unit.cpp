// Suspends warps that wait for a phase of a barrier, and wakes them.
// SPDX-License-Identifier: Apache-2.0
#include "core/mbarrier_unit.h"

#include <algorithm>

#include "isa/mbarrier.h"

namespace glint::core {

std::unique_ptr<MbarrierUnit> MbarrierUnit::make(const CoreParts& core) {
  const auto& code = core.world.image->code;
  for (uint32_t pc = 0; pc < code.size(); ++pc)
    if (core.table.row(pc).is_mbarrier) return std::make_unique<MbarrierUnit>(core);
  return nullptr;
}

MbarrierUnit::MbarrierUnit(const CoreParts& core) : core_(core) {
  waiting_.reserve(core.warps.size());
}

bool MbarrierUnit::come(uint32_t slot, const exec::Issued& issued, Cycle now) {
  WarpSlot& at = core_.warps[slot];
  if (issued.lanes == 0) return false;
  const bool waits =
      isa::MbarrierKind(issued.row->detail) == isa::MbarrierKind::TryWait && at.warp.waits_for_phase;
  if (!waits) {
    look(*at.warp.block, now);
    return false;
  }
  waiting_.push_back({slot, issued.pc, issued.lanes, now, at.warp.block->ended_phases});
  at.front = {kNever, Stall::SharedMemory};
  return true;
}

void MbarrierUnit::look(const exec::Block& block, Cycle now) {
  for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
    exec::WarpContext& warp = core_.warps[waiting->slot].warp;
    const bool may_go = warp.block == &block && waiting->phases != block.ended_phases;
    if (may_go) waiting->phases = block.ended_phases;
    if (may_go && core_.executor.ask_again(warp, waiting->pc, waiting->lanes)) {
      let_go(*waiting, now + core_.params.async.wake, now);
      waiting = waiting_.erase(waiting);
    } else {
      ++waiting;
    }
  }
}

void MbarrierUnit::end_first(Cycle now) {
  while (next_event() <= now) {
    let_go(waiting_.front(), now, now);
    waiting_.erase(waiting_.begin());
  }
}

void MbarrierUnit::let_go(const Waiting& waiting, Cycle at, Cycle now) {
  core_.counts.end(waiting.pc, at - waiting.since);
  core_.warps[waiting.slot].front = {at, Stall::SharedMemory};
  core_.warps.refresh(waiting.slot, now);
}

}  // namespace glint::core
