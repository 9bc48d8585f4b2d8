// Moves stack entries between lanes, and brings the parts of a ray together again.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/work_sharing.h"

#include <bit>
#include <cstddef>
#include <optional>

#include "base/check.h"
#include "rtunit/traversal/split.h"

namespace glint::rt {
namespace {

constexpr LaneMask bit(int lane) {
  return LaneMask{1} << lane;
}

}  // namespace

WorkSharing::WorkSharing(const Params& params, const mem::AddressSpace& memory, WarpBuffer& buffer,
                         RayWalk& walk, RtStats& stats)
    : policy_(params.mapping.make({&stats})),
      moves_per_cycle_(policy_->moves_per_cycle()),
      memory_(memory),
      buffer_(buffer),
      walk_(walk),
      stats_(&stats),
      lanes_(params.slots()) {
  for (uint32_t slot = 0; slot < lanes_.size(); ++slot) {
    lanes_[slot].parts.resize(kLanes);
    buffer_[slot].parts = lanes_[slot].parts.data();
  }
}

void WorkSharing::entered(uint32_t slot, int lane, Cycle) {
  if (buffer_[slot].is_helping(lane)) return;
  Lanes& at = lanes_[slot];
  at.waiting &= ~bit(lane);
  at.ended &= ~bit(lane);
  at.shareable &= ~bit(lane);
  at.helpers[size_t(lane)] = 0;
  if (needs_no_shader(buffer_[slot].states[lane], memory_)) at.shareable |= bit(lane);
  update_giver(slot, lane);
}

// A lane that is between two nodes has a node to visit, or its part or its ray has ended.
bool WorkSharing::detour(uint32_t slot, int lane, Cycle now) {
  Lanes& at = lanes_[slot];
  const BufferSlot& warp = buffer_[slot];
  RayState& work = warp.ray_of(lane);
  if (work.status == RayStatus::Traversing && (at.ended >> warp.owner_of(lane) & 1)) cancel(work);
  if (work.status == RayStatus::Traversing) return false;
  update_giver(slot, lane);
  if (warp.is_helping(lane)) {
    end_part(slot, lane, now);
    return true;
  }
  if (at.helpers[size_t(lane)] == 0) return false;
  GLINT_DCHECK(work.status == RayStatus::Done, "lane {} has helpers and needs a shader", lane);
  at.waiting |= bit(lane);
  return true;
}

void WorkSharing::visited(const Visit& visit) {
  Lanes& at = lanes_[visit.slot];
  const BufferSlot& warp = buffer_[visit.slot];
  const int owner = warp.owner_of(visit.lane);
  RayState& ray = warp.states[owner];
  if (warp.is_helping(visit.lane)) {
    ++stats_.helped_nodes;
    stats_.helper_hits += merge_part(visit.ray, ray);
  }
  if (at.helpers[size_t(owner)] != 0) {
    for_each_lane(warp.helping, [&](int lane) {
      if (warp.owner[size_t(lane)] == owner) share_hit(ray, warp.parts[lane]);
    });
    if (ray.broken || has_left_stack(visit.ray)) at.ended |= bit(owner);
  }
  update_giver(visit.slot, visit.lane);
}

// The top of a stack is the lane's next node. It may be on its way already, so the entries below it are
// given.
void WorkSharing::update_giver(uint32_t slot, int lane) {
  Lanes& at = lanes_[slot];
  const BufferSlot& warp = buffer_[slot];
  const RayState& work = warp.ray_of(lane);
  const bool gives = work.status == RayStatus::Traversing && work.stack_size - 2 >= work.stack_off_chip &&
                     (at.shareable >> warp.owner_of(lane) & 1) && !(at.ended >> warp.owner_of(lane) & 1);
  at.givers = (at.givers & ~bit(lane)) | (gives ? bit(lane) : 0);
  with_givers_ = (with_givers_ & ~(uint64_t{1} << slot)) | uint64_t{at.givers != 0} << slot;
}

LaneMask WorkSharing::takers(uint32_t slot) const {
  const BufferSlot& warp = buffer_[slot];
  return ~(warp.helping | (warp.mask & ~warp.stopped & ~lanes_[slot].waiting));
}

// Returns the oldest of these slots in which a lane can give and another can take, or kNone.
uint32_t WorkSharing::first_to_share(uint64_t slots) const {
  uint32_t oldest = kNone;
  for (uint64_t rest = with_givers_ & slots; rest; rest &= rest - 1) {
    const auto slot = uint32_t(std::countr_zero(rest));
    if (takers(slot) && (oldest == kNone || buffer_[slot].age < buffer_[oldest].age)) oldest = slot;
  }
  return oldest;
}

void WorkSharing::share(Cycle now) {
  uint64_t slots = ~uint64_t{0};
  for (uint32_t left = moves_per_cycle_; left;) {
    const uint32_t slot = first_to_share(slots);
    if (slot == kNone) return;
    const std::optional<WorkMove> move = policy_->choose({lanes_[slot].givers, takers(slot)});
    if (move) {
      make(slot, *move, now);
      --left;
    } else {
      slots &= ~(uint64_t{1} << slot);
    }
  }
}

void WorkSharing::make(uint32_t slot, const WorkMove& move, Cycle now) {
  Lanes& at = lanes_[slot];
  BufferSlot& warp = buffer_[slot];
  GLINT_CHECK((at.givers >> move.from & 1) && (takers(slot) >> move.to & 1),
              "the work mapping moves an entry from lane {} to lane {}, which is not possible", move.from,
              move.to);
  RayState& from = warp.ray_of(move.from);
  RayState& part = at.parts[size_t(move.to)];
  const int owner = warp.owner_of(move.from);
  split_off(from, move.takes_bottom ? size_t(from.stack_off_chip) : size_t(from.stack_size) - 2, part);
  ++stats_.moves;
  update_giver(slot, move.from);
  if (part.status != RayStatus::Traversing) {
    ++stats_.stale_moves;
    return;
  }
  warp.helping |= bit(move.to);
  warp.owner[size_t(move.to)] = uint8_t(owner);
  ++at.helpers[size_t(owner)];
  at.since[size_t(move.to)] = now;
  walk_.start_part(slot, move.to, now);
}

// The last part to end lets a ray go that has waited for it.
void WorkSharing::end_part(uint32_t slot, int lane, Cycle now) {
  Lanes& at = lanes_[slot];
  BufferSlot& warp = buffer_[slot];
  const int owner = warp.owner_of(lane);
  if (warp.parts[lane].broken) {
    warp.states[owner].broken = true;
    at.ended |= bit(owner);
  }
  warp.helping &= ~bit(lane);
  stats_.helper_cycles += now - at.since[size_t(lane)];
  if (--at.helpers[size_t(owner)] != 0 || !(at.waiting >> owner & 1)) return;
  at.waiting &= ~bit(owner);
  walk_.stop(slot, owner, now);
}

}  // namespace glint::rt
