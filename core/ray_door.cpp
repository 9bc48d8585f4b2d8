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
    return;
  }
  if (warp.waiting_for_rays) core_.executor.finish_rays(warp);
  at.front = {now + row.latency, Stall::RtWait};
  core_.counts.end(issued.pc, row.latency);
}

void RayDoor::complete(uint32_t slot, Cycle now) {
  WarpSlot& at = core_.warps[slot];
  const Trip& trip = trips_[slot];
  const IssueRow& row = core_.table.row(trip.pc);
  const Cycle duration = now + row.latency - trip.issued;
  core_.observers.tell([&](CoreObserver& observer) { observer.end_rays(slot, trip.lanes, at.warp.rays); });
  core_.executor.finish_rays(at.warp);
  at.front = {now + row.latency, Stall::RtWait};
  core_.counts.end(trip.pc, duration);
  if (core_.counts.profile) core_.counts.profile->end(trip.pc, duration);
  ++core_.counts.progress;
  core_.warps.refresh(slot, now);
}

}  // namespace glint::core
