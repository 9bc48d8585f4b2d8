// Telling observers what a core does, and which lanes an access of theirs is for.
// SPDX-License-Identifier: Apache-2.0
#include "core/core_cell.h"

namespace glint::core {

void CoreCell::observe(CoreObserver& observer) {
  observers_.push_back(&observer);
  executor_.called.listen([this, &observer](const exec::Called& called) {
    observer.call(uint32_t(&called.warp - warps_.data()), called.stage, called.lanes);
  });
}

// Model: a warp that is ready to go through a door counts as waiting for it, even where only another warp was
// picked before it.
void CoreCell::tell_select(const SchedulerState& scheduler, uint32_t slot, Cycle now) const {
  const uint32_t local = slot / params_.schedulers;
  const auto needs = [local](uint64_t warps) { return (warps >> local & 1) != 0; };
  const Stall door = needs(scheduler.needs_rt)    ? Stall::RtFull
                     : needs(scheduler.needs_tex) ? Stall::TexThrottle
                     : needs(scheduler.needs_lsu) ? Stall::LsuThrottle
                                                  : Stall::Issued;
  for (CoreObserver* observer : observers_)
    observer->select(now, slot, scheduler.ready_at[local], scheduler.wait[local], door, warps_[slot].simt.pc);
}

LaneMask CoreCell::readers_of(mem::Token access, Address line, uint32_t& slot) const {
  const MemoryAccess& of = lsu_.access(access);
  slot = of.slot;
  LaneMask lanes = 0;
  for (const LineSectors& touched : of.lines.lines())
    if (touched.line == line) lanes |= touched.lanes;
  return lanes;
}

}  // namespace glint::core
