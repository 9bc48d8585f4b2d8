// Lets warps into the RT unit's warp buffer and out of it.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/warp_buffer.h"

#include <algorithm>

#include "base/num_lanes.h"

namespace glint::rt {

WarpBuffer::WarpBuffer(const Params& params, RtStats& stats)
    : retires_per_cycle_(params.retires_per_cycle),
      stats_(stats),
      most_rays_(params.oracle.any_lane ? params.warps * kLanes : ~0u),
      slots_(params.slots()),
      finished_(params.slots()),
      completions_(params.slots()) {
}

uint32_t WarpBuffer::admit(Cycle now, uint32_t warp_slot, LaneMask mask, RayState* states) {
  const auto free =
      std::find_if(slots_.begin(), slots_.end(), [](const BufferSlot& s) { return !s.is_used; });
  const auto slot = uint32_t(free - slots_.begin());
  free->is_used = true;
  free->warp_slot = warp_slot;
  free->mask = mask;
  free->wanting = free->stopped = free->helping = 0;
  free->states = states;
  free->age = next_age_++;
  free->arrived = now;
  free->unsent_writes = 0;
  free->next_exit = 0;
  note_change(slot);
  ++num_resident_;
  num_rays_ += num_lanes(mask);
  warp_moved_.fire([&] { return WarpMoved{now, slot, warp_slot, false, mask, states}; });
  return slot;
}

void WarpBuffer::stop(uint32_t slot, int lane, Cycle now) {
  opened_ |= num_rays_-- == most_rays_;
  slots_[slot].stopped |= LaneMask{1} << lane;
  if (slots_[slot].is_done()) leave(slot, now);
}

void WarpBuffer::withdraw(uint32_t slot, int lane, Cycle now) {
  --num_rays_;
  slots_[slot].mask &= ~(LaneMask{1} << lane);
  if (slots_[slot].is_done()) leave(slot, now);
}

void WarpBuffer::write_sent(uint32_t slot, Cycle now) {
  --slots_[slot].unsent_writes;
  if (slots_[slot].is_done()) leave(slot, now);
}

void WarpBuffer::leave(uint32_t slot, Cycle now) {
  for (size_t& next = slots_[slot].next_exit; next < exits_.size();)
    if (exits_[next++]->holds(slot, now)) return;
  finished_.push(slot);
}

void WarpBuffer::retire_finished(Cycle now) {
  for (uint32_t i = 0; i < retires_per_cycle_ && !finished_.empty(); ++i) {
    const uint32_t index = finished_.front();
    BufferSlot& slot = slots_[index];
    finished_.pop();
    warp_moved_.fire([&] { return WarpMoved{now, index, slot.warp_slot, true, slot.mask, slot.states}; });
    completions_.push(slot.warp_slot);
    if (!slot.threads) stats_.warp_latency_sum += now - slot.arrived;
    slot.is_used = false;
    --num_resident_;
  }
}

}  // namespace glint::rt
