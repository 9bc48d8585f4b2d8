// Places waiting rays in warps, and takes them back.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/warp_former.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "base/num_lanes.h"
#include "rtunit/unit/path_keeper.h"

namespace glint::rt {

WarpFormer::WarpFormer(const Params& params, const mem::AddressSpace& memory, Address states, mem::L1Port& l1,
                       WarpBuffer& buffer, FetchQueue& fetches, RayWalk& walk, RtStats& stats)
    : policy_(params.pool.make({&stats, memory, params.warps, params.pool_warps * kLanes})),
      moves_stacks_(params.pool_stacks),
      acknowledgement_(params.shortcuts.store_each_hit ? params.shortcuts.store_latency : 0),
      states_(states),
      l1_(l1),
      buffer_(buffer),
      fetches_(fetches),
      walk_(walk),
      unit_stats_(stats),
      stats_(&stats),
      accepted_(params.pool_warps),
      formed_(params.warps) {
  for (uint32_t slot = 0; slot < formed_.size(); ++slot) buffer_[slot].threads = formed_[slot].threads.data();
}

void WarpFormer::accept(Cycle now, uint32_t warp_slot, LaneMask mask, RayState* states) {
  const auto free =
      std::find_if(accepted_.begin(), accepted_.end(), [](const Accepted& a) { return !a.is_used; });
  const auto number = uint32_t(free - accepted_.begin());
  free->is_used = true;
  free->warp_slot = warp_slot;
  free->arrived = now;
  free->mask = mask;
  free->running = num_lanes(mask);
  free->states = states;
  free->returned = 0;
  ++num_accepted_;
  warp_moved_.fire([&] { return WarpMoved{now, number, warp_slot, false, mask, states}; });
  for_each_lane(mask, [&](int lane) { add_to_pool(number * kLanes + uint32_t(lane), now); });
}

void WarpFormer::add_to_pool(uint32_t id, Cycle now) {
  Accepted& from = of(id);
  from.since[id % kLanes] = now;
  ++num_waiting_;
  has_changed_ = true;
  const bool is_new = !(from.returned >> id % kLanes & 1);
  policy_->add({id, is_new, !is_new && home_of(id).nodes_visited == 0, &home_of(id)}, now);
}

void WarpFormer::form(Cycle now) {
  now_ = now;
  while (buffer_.pop_completion()) {
  }
  has_changed_ = false;
  while (num_waiting_ && buffer_.has_room() && form_warp(now)) {
  }
}

bool WarpFormer::form_warp(Cycle now) {
  std::array<uint32_t, kLanes> ids;
  const uint32_t count = policy_->form(ids, now);
  if (count == 0) {
    GLINT_CHECK(buffer_.num_resident() != 0 || policy_->next_event(now) != kNever,
                "the ray pool forms no warp of {} waiting rays though the RT unit holds none", num_waiting_);
    return false;
  }
  const LaneMask mask = kAllLanes >> (uint32_t(kLanes) - count);
  const uint32_t slot = buffer_.admit(now, 0, mask, nullptr);
  Formed& warp = formed_[slot];
  buffer_[slot].warp_slot = slot;  // The buffer gives this number back when the warp has left.
  buffer_[slot].states = warp.states.data();
  warp.to_load = warp.visited = 0;
  for (uint32_t lane = 0; lane < count; ++lane) {
    Accepted& from = of(ids[lane]);
    warp.id[lane] = ids[lane];
    warp.threads[lane] = {from.warp_slot, int(ids[lane] % kLanes)};
    move_ray(home_of(ids[lane]), warp.states[lane]);
  }
  policy_->formed(slot);
  num_waiting_ -= count;
  ++stats_.formed;
  stats_.formed_rays += count;
  for (int lane = 0; lane < int(count); ++lane) enter(slot, lane, now);
  return true;
}

void WarpFormer::enter(uint32_t slot, int lane, Cycle now) {
  Formed& warp = formed_[slot];
  const uint32_t id = warp.id[size_t(lane)];
  Accepted& from = of(id);
  const Cycle waited = now - from.since[id % kLanes];
  stats_.waited += waited;
  if (!(from.returned >> id % kLanes & 1)) return walk_.start(slot, lane, now, waited);
  warp.states[size_t(lane)].unit_cycles += waited;
  if (warp.states[size_t(lane)].nodes_visited) warp.to_load |= LaneMask{1} << lane;
  walk_.start_elsewhere(slot, lane, now);
}

bool WarpFormer::detour(uint32_t slot, int lane, Cycle now) {
  Formed& warp = formed_[slot];
  if (look_up_ && takes_predicted(slot, lane, now)) return true;
  if (!(warp.to_load >> lane & 1)) return false;
  warp.to_load &= ~(LaneMask{1} << lane);
  moves_.push({warp.id[size_t(lane)], slot, uint8_t(lane), sectors_of(warp.states[size_t(lane)]), true});
  return true;
}

bool WarpFormer::takes_back(uint32_t slot, int lane, Cycle now) {
  Formed& warp = formed_[slot];
  if (!(warp.visited >> lane & 1)) return false;
  warp.visited &= ~(LaneMask{1} << lane);
  if (warp.states[size_t(lane)].status != RayStatus::Traversing) return false;
  if (!policy_->goes_back(view_of(slot), lane)) return false;
  take_back(slot, lane, now);
  return true;
}

bool WarpFormer::takes_predicted(uint32_t slot, int lane, Cycle now) {
  const uint32_t id = formed_[slot].id[size_t(lane)];
  if (of(id).returned >> id % kLanes & 1 || !look_up_->has_prediction(slot, lane)) return false;
  if (!policy_->takes_predicted(view_of(slot), lane)) return false;
  take_back(slot, lane, now);
  return true;
}

void WarpFormer::take_back(uint32_t slot, int lane, Cycle now) {
  RayState& ray = formed_[slot].states[size_t(lane)];
  const uint32_t id = formed_[slot].id[size_t(lane)];
  ray.unit_cycles += now - buffer_[slot].arrived;
  if (ray.nodes_visited) moves_.push({id, slot, uint8_t(lane), sectors_of(ray), false});
  of(id).returned |= LaneMask{1} << id % kLanes;
  ++stats_.returned;
  move_ray(ray, home_of(id));
  add_to_pool(id, now);
  buffer_.withdraw(slot, lane, now);
}

FormedWarp WarpFormer::view_of(uint32_t slot) const {
  const BufferSlot& at = buffer_[slot];
  return {slot, at.mask & ~at.stopped, num_waiting_, formed_[slot].states};
}

void WarpFormer::note_stop(uint32_t slot, int lane) {
  const uint32_t id = formed_[slot].id[size_t(lane)];
  move_ray(formed_[slot].states[size_t(lane)], home_of(id));
  if (--of(id).running == 0) complete_.push({now_ + 1 + acknowledgement_, id / kLanes});
}

std::optional<uint32_t> WarpFormer::pop_completion(Cycle now) {
  if (complete_.empty() || complete_.front().ready > now) return std::nullopt;
  const uint32_t number = complete_.front().number;
  Accepted& warp = accepted_[number];
  complete_.pop();
  warp_moved_.fire([&] { return WarpMoved{now, number, warp.warp_slot, true, warp.mask, warp.states}; });
  unit_stats_.warp_latency_sum += now - warp.arrived;
  warp.is_used = false;
  --num_accepted_;
  return warp.warp_slot;
}

// Returns the sectors that hold a ray and as much of its stack as has room in its line.
uint8_t WarpFormer::sectors_of(const RayState& ray) const {
  const int entries = moves_stacks_ ? ray.stack_size - ray.stack_off_chip : 0,
            sectors = 1 + (entries + kEntriesPerSector - 1) / kEntriesPerSector;
  return uint8_t(std::min(sectors, int(std::min(kStateBytes, l1_.line_bytes()) / mem::kSectorBytes)));
}

bool WarpFormer::has_request(Cycle now) const {
  if (moves_.empty()) return false;
  const Move& move = moves_.front();
  return !move.is_read || (buffer_[move.slot].arrived < now && !fetches_.is_full());
}

Cycle WarpFormer::next_event(Cycle now) const {
  if (has_request(now) || (has_reads_waiting() && !fetches_.is_full())) return now + 1;
  if (num_waiting_ && buffer_.has_room()) {
    if (has_changed_) return now + 1;
    const Cycle next = policy_->next_event(now);
    return complete_.empty() ? next : std::min(next, std::max(complete_.front().ready, now + 1));
  }
  return complete_.empty() ? kNever : std::max(complete_.front().ready, now + 1);
}

bool WarpFormer::send(Cycle now) {
  const Move move = moves_.front();
  const Address at = states_ + Address{move.id} * kStateBytes, offset = at & (l1_.line_bytes() - 1);
  mem::Request request;
  request.line = at - offset;
  request.sectors = uint8_t(((1u << move.sectors) - 1) << offset / mem::kSectorBytes);
  request.write = !move.is_read;
  request.traffic = mem::Traffic::RtStack;
  if (move.is_read) request.token = fetches_.open(move.slot, move.lane);
  if (!l1_.access(now, mem::Client::RtUnit, request)) {
    if (move.is_read) fetches_.cancel(request.token);
    return false;
  }
  moves_.pop();
  ++(move.is_read ? stats_.state_reads : stats_.state_writes);
  return true;
}

}  // namespace glint::rt
