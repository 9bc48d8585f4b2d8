// Follows each looked-up ray from its look-up to its end.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/entry_look_up.h"

#include <utility>

#include "rtunit/traversal/split.h"
#include "rtunit/traversal/traversal.h"

namespace glint::rt {
namespace {

Pipe pipe_for(const RayEntry::Timing& timing, TestPipelines& pipelines) {
  return pipelines.add({timing.latency, timing.interval, timing.units});
}

}  // namespace

EntryLookUp::EntryLookUp(std::unique_ptr<RayEntry> policy, const mem::AddressSpace& memory,
                         WarpBuffer& buffer, TestPipelines& pipelines, RtStats& stats)
    : policy_(std::move(policy)),
      memory_(memory),
      buffer_(buffer),
      pipelines_(pipelines),
      stats_(&stats),
      pipe_(pipe_for(policy_->timing(), pipelines)) {
}

// A ray that comes back from a shader was not looked up, because it needs shaders.
void EntryLookUp::entered(uint32_t slot, int lane, Cycle) {
  if (buffer_[slot].is_helping(lane)) return;
  if (const size_t needed = buffer_[slot].place_of(lane).warp_slot + 1; lanes_.size() < needed)
    lanes_.resize(needed);
  Lane& at = lane_of(slot, lane) = {};
  const RayState& ray = buffer_[slot].ray_of(lane);
  if (ray.nodes_visited == 0 && needs_no_shader(ray, memory_) && policy_->wants(ray.ray))
    at.phase = Phase::New;
}

bool EntryLookUp::has_prediction(uint32_t slot, int lane) const {
  const auto [warp_slot, own_lane] = buffer_[slot].place_of(lane);
  const Lane& at = lanes_[warp_slot][size_t(own_lane)];
  return at.phase == Phase::LookingUp && at.start;
}

bool EntryLookUp::detour(uint32_t slot, int lane, Cycle) {
  if (buffer_[slot].is_helping(lane)) return false;
  Lane& at = lane_of(slot, lane);
  if (at.phase == Phase::New) {
    at.phase = Phase::LookingUp;
    Read& read = buffer_[slot].read[size_t(lane)];
    read.set({}, pipe_, this);
    pipelines_.push(read, slot, LaneMask{1} << lane);
    return true;
  }
  if (at.phase != Phase::LookingUp) return false;
  at.phase = Phase::Walking;
  if (!at.start) return false;
  const Fetch leaf{at.start->instance_leaf, sizeof(InstanceLeaf), NodeKind::Instance};
  if (!memory_.find(leaf.address, leaf.bytes)) {
    miss_subtree(at);
    return false;
  }
  at.phase = Phase::Entering;
  buffer_.want(slot, lane, leaf, kTransformPipe, this);
  return true;
}

void EntryLookUp::errand_started(uint32_t slot, int lane) {
  Lane& at = lane_of(slot, lane);
  RayState& ray = buffer_[slot].ray_of(lane);
  if (at.phase == Phase::LookingUp) {
    at.start = policy_->look_up(ray);
    at.ending.was_predicted = at.start.has_value();
    ++stats_.looked_up;
    stats_.predicted += at.ending.was_predicted;
  } else if (start_at(ray, memory_, *at.start)) {
    at.phase = Phase::Ahead;
  } else {
    miss_subtree(at);
  }
}

void EntryLookUp::visited(const Visit& visit) {
  Lane& at = lane_of(visit.slot, visit.lane);
  if (at.phase == Phase::Other || buffer_[visit.slot].is_helping(visit.lane)) return;
  const Hit& hit = visit.ray.committed;
  const bool has_hit = hit.valid() && hit.triangle_leaf == visit.node.address;
  if (at.phase == Phase::Walking) {
    if (has_hit) at.ending.learned = policy_->learn(visit.ray, hit);
    return;
  }
  ++stats_.predicted_nodes;
  ++at.nodes;
  if (has_hit && !std::exchange(at.ending.was_verified, true)) ++stats_.verified;
  if (visit.ray.bottom_stack_base >= 0 && visit.ray.status == RayStatus::Traversing) return;
  at.phase = Phase::Walking;
  if (!at.ending.was_verified) miss_subtree(at);
}

void EntryLookUp::miss_subtree(Lane& at) {
  at.phase = Phase::Walking;
  ++stats_.wrong;
  stats_.wasted_nodes += at.nodes;
}

void EntryLookUp::stopped(uint32_t slot, int lane) {
  Lane& at = lane_of(slot, lane);
  if (at.phase == Phase::Other) return;
  policy_->ended(buffer_[slot].states[lane], at.ending);
  at.phase = Phase::Other;
}

}  // namespace glint::rt
