// Makes the steps of a ray's walk in the RT unit.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/ray_walk.h"

#include <algorithm>
#include <cstddef>

#include "base/check.h"
#include "rtunit/traversal/traversal.h"

namespace glint::rt {

RayWalk::RayWalk(const Params& params, const mem::AddressSpace& memory, WarpBuffer& buffer, RtStats& stats)
    : retest_(params.retest),
      memory_(memory),
      buffer_(buffer),
      stats_(stats),
      nodes_of_kind_{&stats.internal_nodes, &stats.instance_leaves, &stats.triangle_leaves,
                     &stats.procedural_leaves, &stats.triangle_leaves},
      child_order_(params.child_order.make({})) {
}

void RayWalk::start(uint32_t slot, int lane, Cycle now, Cycle waited) {
  RayState& ray = buffer_[slot].ray_of(lane);
  GLINT_DCHECK(ray.status == RayStatus::Traversing, "lane {} has no ray to traverse", lane);
  if (ray.nodes_visited == 0) {
    ++stats_.rays;
    ray.unit_cycles = 0;
    if (ray.ray.flags & ray_flag::kTerminateOnFirstHit) ++stats_.first_hit_rays;
  } else {
    ++stats_.resumed;
    // stop() counted the ray when it was given back to the core, but its walk goes on, so the count is taken
    // back.
    stats_.ray_nodes.remove(ray.nodes_visited);
    stats_.ray_latency.remove(ray.unit_cycles);
  }
  ray.unit_cycles += waited;
  ray.rules.retest = retest_;
  ray.rules.order = child_order_->for_rays();
  start_part(slot, lane, now);
}

void RayWalk::start_part(uint32_t slot, int lane, Cycle now) {
  for (WalkHook* hook : hooks_) hook->entered(slot, lane, now);
  go_on(slot, lane, now);
}

void RayWalk::start_elsewhere(uint32_t slot, int lane, Cycle now) {
  for (WalkHook* hook : hooks_) hook->moved(slot, lane, now);
  go_on(slot, lane, now);
}

void RayWalk::go_on(uint32_t slot, int lane, Cycle now) {
  if (!hooks_.empty()) [[unlikely]]
    for (WalkHook* hook : hooks_)
      if (hook->detour(slot, lane, now)) return;
  RayState& ray = buffer_[slot].ray_of(lane);
  if (ray.status == RayStatus::Traversing) [[likely]] {
    const Fetch node = next_fetch(ray);
    if (const std::byte* bytes = memory_.find(node.address, node.bytes)) [[likely]] {
      // The node is tested many cycles from now.
      __builtin_prefetch(bytes);
      __builtin_prefetch(bytes + node.bytes - 1);
      return buffer_.want(slot, lane, node, pipe_of(node.kind));
    }
    break_off(ray);
    return go_on(slot, lane, now);
  }
  stop(slot, lane, now);
}

void RayWalk::start_test(uint32_t slot, int lane, Cycle now) {
  if (WalkHook* errand = buffer_[slot].read[size_t(lane)].errand) [[unlikely]]
    errand->errand_started(slot, lane);
  else
    visit(slot, lane, now);
}

void RayWalk::end_test(uint32_t slot, int lane, Cycle now) {
  if (!hooks_.empty()) [[unlikely]]
    for (WalkHook* hook : hooks_) hook->test_ended(slot, lane);
  go_on(slot, lane, now);
}

void RayWalk::visit(uint32_t slot, int lane, Cycle now) {
  const Fetch& node = buffer_[slot].read[size_t(lane)].what;
  RayState& ray = buffer_[slot].ray_of(lane);
  node_visited_.fire([&] {
    const Thread thread = buffer_[slot].thread_of(lane);
    return NodeVisited{now, thread.warp_slot, thread.lane, node};
  });
  const uint32_t boxes = ray.box_tests, triangles = ray.triangle_tests, hits = ray.hits_in_interval;
  const int before = ray.stack_size;
  if (!retest_ && ray.stack[size_t(ray.stack_size) - 1].t_enter > ray.committed.t) ++stats_.stale_nodes;
  step(ray, memory_.find(node.address, node.bytes));
  stats_.box_tests += ray.box_tests - boxes;
  stats_.triangle_tests += ray.triangle_tests - triangles;
  ++stats_.nodes;
  ++*nodes_of_kind_[size_t(node.kind)];
  // The step takes the node off the stack. What it pushes is never behind the ray's hit, so it stays there.
  const auto pushed = uint32_t(std::max(ray.stack_size - before + 1, 0));
  if (!hooks_.empty()) [[unlikely]]
    for (WalkHook* hook : hooks_)
      hook->visited({now, slot, lane, ray, node, ray.hits_in_interval - hits, pushed});
}

// A shader that gets the ray may end its walk, so the ray is counted now. start() takes the count back when
// the ray returns.
void RayWalk::stop(uint32_t slot, int lane, Cycle now) {
  RayState& ray = buffer_[slot].states[lane];
  ray.unit_cycles += now - buffer_[slot].arrived;
  stats_.ray_latency.add(ray.unit_cycles);
  stats_.ray_nodes.add(ray.nodes_visited);
  stats_.most_nodes = std::max(stats_.most_nodes, ray.nodes_visited);
  stats_.deepest_stack = std::max(stats_.deepest_stack, uint32_t(ray.stack_peak));
  const bool has_ended =
      ray.status == RayStatus::Done || (ray.status == RayStatus::Gathered && ray.stack_size == 0);
  if (has_ended)
    ++stats_.finished;
  else
    ++stats_.suspended;
  for (WalkHook* hook : hooks_) hook->stopped(slot, lane);
  buffer_.stop(slot, lane, now);
}

}  // namespace glint::rt
