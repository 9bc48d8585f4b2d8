// One cycle of the RT unit, back to front.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/rt_unit.h"

#include <algorithm>

#include "base/check.h"
#include "base/num_lanes.h"

namespace glint::rt {
RtUnit::RtUnit(const Params& params, const Context& context)
    : params_(params),
      memory_(context.memory),
      l1_(context.l1),
      results_(context.results),
      tables_(context.tables),
      stats_(context.stats),
      scheduler_(params.scheduler.make({&stats_})),
      slots_(params.warps),
      views_(params.warps),
      fetches_(size_t(params.warps) * kLanes),
      pipes_{Pipeline{params.box, mem::Ring<Test>(fetches_.size()), mem::Ring<Running>(fetches_.size())},
             Pipeline{params.triangle, mem::Ring<Test>(fetches_.size()), mem::Ring<Running>(fetches_.size())},
             Pipeline{params.transform, mem::Ring<Test>(fetches_.size()), mem::Ring<Running>(fetches_.size())}},
      finished_(params.warps),
      writing_(params.warps),
      gathering_(params.warps),
      completions_(params.warps) {
  for (size_t i = fetches_.size(); i-- > 0;) free_fetches_.push_back(uint32_t(i));
}

void RtUnit::submit(Cycle now, uint32_t warp_slot, LaneMask mask, RayState* states) {
  GLINT_CHECK(can_accept() && mask != 0, "warp {} submitted to a full RT unit or without rays", warp_slot);
  const auto free = std::find_if(slots_.begin(), slots_.end(), [](const Slot& s) { return !s.used; });
  free->used = true;
  free->warp = warp_slot;
  free->mask = mask;
  free->wanting = free->stopped = free->unwritten = free->rows = 0;
  free->states = states;
  free->age = next_age_++;
  free->arrived = now;
  ++num_resident_;
  num_rays_ += uint32_t(std::popcount(mask));
  ++stats_.warps;
  for_each_lane(mask, [&](int lane) {
    GLINT_DCHECK(states[lane].status == RayStatus::Traversing, "lane {} has no ray to traverse", lane);
    if (states[lane].nodes_visited == 0) {
      ++stats_.rays;
      if (states[lane].ray.flags & ray_flag::kTerminateOnFirstHit) ++stats_.first_hit_rays;
    } else {
      ++stats_.resumed;
    }
    place(uint32_t(free - slots_.begin()), lane, now);
  });
}

std::optional<uint32_t> RtUnit::pop_completion(Cycle) {
  if (completions_.empty()) return std::nullopt;
  const uint32_t warp = completions_.front();
  completions_.pop();
  return warp;
}

void RtUnit::tick(Cycle now) {
  account_gap(now);
  retire(now);
  finish_tests(now);
  receive_nodes(now);
  start_tests(now);
  account(now, send_requests(now));
}

Cycle RtUnit::next_event(Cycle now) const {
  if (!completions_.empty() || !finished_.empty() || wants_to_send()) return now + 1;
  Cycle next = kNever;
  for (const Pipeline& pipe : pipes_) {
    if (!pipe.running.empty()) next = std::min(next, pipe.running.front().ready);
    if (!pipe.waiting.empty()) next = std::min(next, pipe.interval_start + pipe.params.interval);
  }
  return next == kNever ? next : std::max(next, now + 1);
}

bool RtUnit::wants_to_send() const {
  if (sending_ != kNone || !writing_.empty() || !gathering_.empty()) return true;
  for (const Slot& slot : slots_)
    if (slot.wanting) return true;
  return false;
}

void RtUnit::account_gap(Cycle now) {
  if (now <= next_unaccounted_) return;
  const uint64_t skipped = now - next_unaccounted_;
  stats_.cycles.add(gap_reason_, skipped);
  stats_.unit_cycles += skipped;
  stats_.warp_cycles += skipped * gap_warps_;
  stats_.lane_slots += skipped * gap_warps_ * kLanes;
  stats_.ray_cycles += skipped * gap_rays_;
  next_unaccounted_ = now;
}

void RtUnit::account(Cycle now, Stall reason) {
  if (now < next_unaccounted_) return;  // ticked twice in a cycle: counted once
  stats_.cycles.add(reason);
  ++stats_.unit_cycles;
  stats_.warp_cycles += num_resident_;
  stats_.lane_slots += uint64_t(num_resident_) * kLanes;
  stats_.ray_cycles += num_rays_;
  next_unaccounted_ = now + 1;
  gap_reason_ = waiting_reason();
  gap_warps_ = num_resident_;
  gap_rays_ = num_rays_;
}

// What a cycle in which nothing is sent is spent on.
Stall RtUnit::waiting_reason() const {
  for (const Pipeline& pipe : pipes_)
    if (!pipe.waiting.empty()) return Stall::TestBusy;
  if (num_fetches_) return Stall::WaitingMemory;
  for (const Pipeline& pipe : pipes_)
    if (!pipe.running.empty()) return Stall::TestLatency;
  return num_resident_ ? Stall::Handover : Stall::Idle;
}

// Gives finished warps back: those of earlier cycles, so a slot freed now is usable from now on.
void RtUnit::retire(Cycle now) {
  for (uint32_t i = 0; i < params_.retires_per_cycle && !finished_.empty(); ++i) {
    Slot& slot = slots_[finished_.front()];
    finished_.pop();
    completions_.push(slot.warp);
    stats_.warp_latency_sum += now - slot.arrived;
    slot.used = false;
    --num_resident_;
  }
}

void RtUnit::finish_tests(Cycle now) {
  for (Pipeline& pipe : pipes_)
    while (!pipe.running.empty() && pipe.running.front().ready <= now) {
      const Running done = pipe.running.front();
      pipe.running.pop();
      place(done.slot, done.lane, now);
    }
}

// A lane between two nodes: it wants the next one, or has stopped.
void RtUnit::place(uint32_t slot_index, int lane, Cycle now) {
  Slot& slot = slots_[slot_index];
  RayState& state = slot.states[lane];
  if (state.status == RayStatus::Traversing) {
    const Fetch node = next_fetch(state);
    if (memory_.find(node.address, node.bytes)) {
      slot.node[size_t(lane)] = node;
      slot.wanting |= LaneMask{1} << lane;
      return;
    }
    break_off(state);
  }
  stop(slot, slot_index, lane, now);
}

void RtUnit::stop(Slot& slot, uint32_t slot_index, int lane, Cycle now) {
  const RayState& state = slot.states[lane];
  stats_.ray_latency.add(now - slot.arrived);
  const bool has_ended = state.status == RayStatus::Done || (state.status == RayStatus::Gathered && state.stack_size == 0);
  if (has_ended) {
    ++stats_.finished;
    stats_.ray_nodes.add(state.nodes_visited);
    stats_.most_nodes = std::max(stats_.most_nodes, state.nodes_visited);
    stats_.deepest_stack = std::max(stats_.deepest_stack, uint32_t(state.stack_peak));
  } else {
    ++stats_.suspended;
  }
  --num_rays_;
  slot.stopped |= LaneMask{1} << lane;
  leave(slot_index);
}

// Lets a warp go whose lanes have all stopped and whose table is in memory.
void RtUnit::leave(uint32_t slot_index) {
  Slot& slot = slots_[slot_index];
  if (slot.stopped != slot.mask || slot.rows != 0) return;
  if (params_.result_store) {
    slot.unwritten = slot.mask;
    writing_.push(slot_index);
  } else {
    finished_.push(slot_index);
  }
}

// Nodes that have arrived go to the pipelines, lane by lane.
void RtUnit::receive_nodes(Cycle now) {
  for (uint32_t i = 0; i < params_.responses_per_cycle; ++i) {
    const std::optional<mem::Token> token = l1_.pop(now, mem::Client::RtUnit);
    if (!token) return;
    NodeFetch& fetch = fetches_[*token];
    --fetch.unanswered;
    if (fetch.unanswered || fetch.sent < fetch.node.bytes) continue;
    const NodeKind kind = fetch.node.kind;
    Test test{fetch.slot};
    Pipe pipe = kBox;
    if (kind == NodeKind::Instance) pipe = kTransform;
    if (kind == NodeKind::Triangle || kind == NodeKind::TriangleSecond) pipe = kTriangle;
    if (kind == NodeKind::Triangle) {
      TriangleLeaf leaf;
      std::memcpy(&leaf, memory_.find(fetch.node.address, sizeof leaf), sizeof leaf);
      test.starts_left = leaf.count > 1 ? 2 : 1;
    }
    for_each_lane(fetch.lanes, [&](int lane) {
      test.lane = uint8_t(lane);
      pipes_[pipe].waiting.push(test);
    });
    --num_fetches_;
    free_fetches_.push_back(*token);
  }
}

void RtUnit::start_tests(Cycle now) {
  for (Pipeline& pipe : pipes_) {
    if (pipe.waiting.empty()) continue;
    if (!pipe.used || now >= pipe.interval_start + pipe.params.interval) {
      pipe.used = true;
      pipe.interval_start = now;
      pipe.started = 0;
    }
    for (; pipe.started < pipe.params.units && !pipe.waiting.empty(); ++pipe.started) {
      Test& test = pipe.waiting.front();
      if (--test.starts_left) continue;
      visit(test, now);
      pipe.running.push({now + pipe.params.latency, test.slot, test.lane});
      pipe.waiting.pop();
    }
  }
}

// The functional step: made when the test starts, seen by the unit when it ends.
void RtUnit::visit(const Test& test, Cycle now) {
  const Slot& slot = slots_[test.slot];
  const Fetch& node = slot.node[test.lane];
  RayState& state = slot.states[test.lane];
  node_visited_.fire([&] { return NodeVisited{now, slot.warp, test.lane, node}; });
  const uint32_t boxes = state.box_tests, triangles = state.triangle_tests;
  step(state, memory_.find(node.address, node.bytes));
  stats_.box_tests += state.box_tests - boxes;
  stats_.triangle_tests += state.triangle_tests - triangles;
  if (state.table) collect_entries(test.slot, test.lane);
  ++stats_.nodes;
  switch (node.kind) {
    case NodeKind::Internal: ++stats_.internal_nodes; break;
    case NodeKind::Instance: ++stats_.instance_leaves; break;
    case NodeKind::Triangle:
    case NodeKind::TriangleSecond: ++stats_.triangle_leaves; break;
    case NodeKind::Procedural: ++stats_.procedural_leaves; break;
  }
}

}  // namespace glint::rt
