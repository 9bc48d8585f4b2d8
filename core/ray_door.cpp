// Implements the door between a core and its RT unit.
// SPDX-License-Identifier: Apache-2.0
#include "core/ray_door.h"

#include "base/num_lanes.h"

namespace glint::core {

void RayDoor::start(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now) {
  WarpSlot& at = core_.warps[slot];
  exec::WarpContext& warp = at.warp;
  LaneMask travelling = 0;
  if (warp.waiting_for_rays) {
    for_each_lane(issued.lanes, [&](int lane) {
      if (warp.rays[lane].status == rt::RayStatus::Traversing) travelling |= LaneMask{1} << lane;
    });
  }
  if (travelling) {
    core_.observers.tell([&](CoreObserver& observer) { observer.start_rays(slot, travelling, warp.rays); });
    rt_.submit(now, slot, travelling, warp.rays);
    at.front = {kNever, Stall::RtWait};
    trips_[slot] = {now, issued.pc, travelling};
    ++core_.counts.stats.rt_warps;
    core_.counts.stats.rt_lanes += num_lanes(travelling);
    if (parking_ && has_saved_registers(issued.pc))
      parking_->start(slot, uint32_t(num_lanes(travelling)), now);
    return;
  }
  if (warp.waiting_for_rays) core_.executor.finish_rays(warp);
  at.front = {now + row.latency, Stall::RtWait};
  core_.counts.end(issued.pc, row.latency);
}

// At a trace every live value is on the stack (docs/abi.md); at rq.proceed registers are live.
bool RayDoor::has_saved_registers(uint32_t pc) const {
  return isa::effect_row(core_.world.image->code[pc].effect).family == isa::EffectFamily::Trace;
}

void RayDoor::complete(uint32_t slot, Cycle now, Cycle later) {
  WarpSlot& at = core_.warps[slot];
  const Trip& trip = trips_[slot];
  const IssueRow& row = core_.table.row(trip.pc);
  const Cycle done = now + later + row.latency, duration = done - trip.issued;
  core_.observers.tell([&](CoreObserver& observer) { observer.end_rays(slot, trip.lanes, at.warp.rays); });
  core_.executor.finish_rays(at.warp);
  at.front = {done, later ? Stall::Dispatch : Stall::RtWait};
  core_.counts.end(trip.pc, duration);
  if (core_.counts.profile) core_.counts.profile->end(trip.pc, duration);
  ++core_.counts.progress;
  core_.warps.refresh(slot, now);
}

}  // namespace glint::core
