// One cycle of the RT unit, back to front.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/rt_unit.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/check.h"
#include "base/num_lanes.h"

namespace glint::rt {
namespace {

bool has_descriptor(NodeKind kind) {
  return kind != NodeKind::Internal && kind != NodeKind::Instance;
}

}  // namespace

uint64_t RtUnit::result_bytes(const Params& params) {
  if (params.shortcuts.store_each_hit) return uint64_t{kHitPlaces} * kHitPlaceBytes;
  return params.result_store ? uint64_t{params.warps} * kLanes * mem::kSectorBytes : 0;
}

uint64_t RtUnit::stack_bytes_per_warp(const Params& params) {
  return StackLayout{0, params.stack.make({})->rows()}.bytes_per_warp();
}

RtUnit::RtUnit(const Params& params, const Context& context)
    : params_(params),
      memory_(context.memory),
      l1_(context.l1),
      results_(context.results),
      tables_(context.tables),
      stats_(context.stats),
      scheduler_(params.scheduler.make({&stats_})),
      coalescer_(params.coalescing.make({})),
      child_order_(params.child_order.make({})),
      stack_model_(params.stack.make({})),
      stacks_{context.stacks, stack_model_->rows()},
      tends_stacks_(stacks_.rows != 0 || stack_model_->keeps_path()),
      slots_(params.warps),
      views_(params.warps),
      fetches_(size_t(params.warps) * kLanes),
      pipes_{Pipeline(params.box, fetches_.size()), Pipeline(params.triangle, fetches_.size()),
             Pipeline(params.transform, fetches_.size()),
             Pipeline({params.shortcuts.header_latency, 1, kNone}, fetches_.size()),
             Pipeline({params.shortcuts.descriptor_latency, 1, kNone}, fetches_.size())},
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
  free->wanting = free->stopped = free->unwritten = free->rows = free->headers = free->described = 0;
  free->stores = 0;
  free->last_store = 0;
  free->states = states;
  free->age = next_age_++;
  free->arrived = now;
  ++num_resident_;
  num_rays_ += uint32_t(std::popcount(mask));
  ++stats_.warps;
  free->spills = 0;
  has_news_ = true;
  warp_moved_.fire(
      [&] { return WarpMoved{now, uint32_t(free - slots_.begin()), warp_slot, false, mask, states}; });
  for_each_lane(mask, [&](int lane) { admit(*free, uint32_t(free - slots_.begin()), lane, now); });
}

void RtUnit::admit(Slot& slot, uint32_t slot_index, int lane, Cycle now) {
  RayState& state = slot.states[lane];
  GLINT_DCHECK(state.status == RayStatus::Traversing, "lane {} has no ray to traverse", lane);
  if (state.nodes_visited == 0) {
    ++stats_.rays;
    state.unit_cycles = 0;
    if (params_.shortcuts.fetch_headers) slot.headers |= LaneMask{1} << lane;
    if (state.ray.flags & ray_flag::kTerminateOnFirstHit) ++stats_.first_hit_rays;
  } else {
    ++stats_.resumed;
    stats_.ray_nodes.remove(state.nodes_visited);  // as it was given back: its walk goes on
    stats_.ray_latency.remove(state.unit_cycles);
  }
  state.rules.retest = params_.retest;
  state.rules.order = child_order_->for_rays();
  slot.stack[size_t(lane)] = {};
  if (tends_stacks_) {
    if (stack_model_->keeps_path()) keep_path(state, slot.warp, lane);
    slot.stack[size_t(lane)] = stack_model_->settle(state);
  }
  place(slot_index, lane, now);
}

std::optional<uint32_t> RtUnit::pop_completion(Cycle) {
  if (completions_.empty()) return std::nullopt;
  const uint32_t warp = completions_.front();
  completions_.pop();
  return warp;
}

void RtUnit::tick(Cycle now) {
  has_news_ = false;
  account_gap(now);
  retire(now);
  if (num_leaving_) acknowledge(now);
  finish_tests(now);
  receive_nodes(now);
  start_tests(now);
  const Stall done = send_requests(now);
  if (params_.shortcuts.same_cycle_hits) {
    receive_nodes(now);
    start_tests(now);
  }
  account(now, done);
}

Cycle RtUnit::next_event(Cycle now) const {
  if (has_news_ || !completions_.empty() || !finished_.empty() || wants_to_send(now)) return now + 1;
  Cycle next = kNever;
  if (num_leaving_)
    for (const Slot& slot : slots_)
      if (slot.is_leaving) next = std::min(next, slot.last_store + params_.shortcuts.store_latency);
  for (const Pipeline& pipe : pipes_) {
    if (!pipe.running.empty()) next = std::min(next, pipe.running.front().ready);
    if (!pipe.waiting.empty()) next = std::min(next, pipe.interval_start + pipe.params.interval);
  }
  return next == kNever ? next : std::max(next, now + 1);
}

bool RtUnit::wants_to_send(Cycle now) const {
  if (sending_ != kNone || num_stores_ || can_send_stack(now) || !writing_.empty() || !gathering_.empty())
    return true;
  return !is_mshr_full() && has_reads_waiting();
}

// But for an entry they could be sent.
bool RtUnit::has_reads_waiting() const {
  if (!stack_ops_.empty()) return true;
  for (const Slot& slot : slots_)
    if (slot.wanting) return true;
  return false;
}

// Gives finished warps back: those of earlier cycles, so a slot freed now is usable from now on.
void RtUnit::retire(Cycle now) {
  for (uint32_t i = 0; i < params_.retires_per_cycle && !finished_.empty(); ++i) {
    const uint32_t index = finished_.front();
    Slot& slot = slots_[index];
    finished_.pop();
    warp_moved_.fire([&] { return WarpMoved{now, index, slot.warp, true, slot.mask, slot.states}; });
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
      slots_[done.slot].stores += done.stores;
      num_stores_ += done.stores;
      place(done.slot, done.lane, now);
    }
}

// A lane between two nodes: it wants the next one, or has stopped.
void RtUnit::place(uint32_t slot_index, int lane, Cycle now) {
  if (tends_stacks_ && tend_stack(slot_index, lane)) return;
  Slot& slot = slots_[slot_index];
  RayState& state = slot.states[lane];
  if (state.status == RayStatus::Traversing) {
    const Fetch node = next_read(slot, lane);
    if (const std::byte* bytes = memory_.find(node.address, node.bytes)) {
      __builtin_prefetch(bytes);  // it is tested many cycles from now
      slot.node[size_t(lane)] = node;
      slot.wanting |= LaneMask{1} << lane;
      return;
    }
    break_off(state);
  }
  stop(slot, slot_index, lane, now);
}

// The next node, or what is read on its own before it.
Fetch RtUnit::next_read(Slot& slot, int lane) const {
  const RayState& state = slot.states[lane];
  Part& part = slot.part[size_t(lane)];
  if (slot.headers >> lane & 1) {
    part = Part::Header;
    return {state.base, sizeof(StructureHeader), NodeKind::Internal};
  }
  Fetch node = next_fetch(state);
  part = Part::Node;
  if (params_.shortcuts.fetch_descriptors && has_descriptor(node.kind) && !(slot.described >> lane & 1)) {
    part = Part::Descriptor;
    node.bytes = 8;
  }
  return node;
}

void RtUnit::stop(Slot& slot, uint32_t slot_index, int lane, Cycle now) {
  RayState& state = slot.states[lane];
  // A shader that gets the ray may end its walk, so the ray is counted now; admit() takes that back if it
  // returns.
  state.unit_cycles += now - slot.arrived;
  stats_.ray_latency.add(state.unit_cycles);
  stats_.ray_nodes.add(state.nodes_visited);
  stats_.most_nodes = std::max(stats_.most_nodes, state.nodes_visited);
  stats_.deepest_stack = std::max(stats_.deepest_stack, uint32_t(state.stack_peak));
  const bool has_ended =
      state.status == RayStatus::Done || (state.status == RayStatus::Gathered && state.stack_size == 0);
  if (has_ended)
    ++stats_.finished;
  else
    ++stats_.suspended;
  --num_rays_;
  slot.stopped |= LaneMask{1} << lane;
  leave(slot_index, now);
}

// Lets a warp go whose lanes have all stopped and whose hits and table are in memory.
void RtUnit::leave(uint32_t slot_index, Cycle now) {
  Slot& slot = slots_[slot_index];
  if (slot.stopped != slot.mask || slot.rows != 0 || slot.stores != 0 || slot.spills != 0) return;
  if (slot.last_store && slot.last_store + params_.shortcuts.store_latency > now) {
    slot.is_leaving = true;
    ++num_leaving_;
  } else if (params_.result_store) {
    slot.unwritten = slot.mask;
    writing_.push(slot_index);
  } else {
    finished_.push(slot_index);
  }
}

// The last stores of these warps have been acknowledged.
void RtUnit::acknowledge(Cycle now) {
  for (uint32_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].is_leaving || slots_[i].last_store + params_.shortcuts.store_latency > now) continue;
    slots_[i].is_leaving = false;
    --num_leaving_;
    leave(i, now);
  }
}

RtUnit::Pipe RtUnit::pipe_for(const NodeFetch& fetch) {
  if (fetch.part == Part::Header) return kHeader;
  if (fetch.part == Part::Descriptor) return kDescriptor;
  switch (fetch.node.kind) {
    case NodeKind::Instance:
      return kTransform;
    case NodeKind::Triangle:
    case NodeKind::TriangleSecond:
      return kTriangle;
    default:
      return kBox;
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
    --num_fetches_;
    hand_out(*token, now);
  }
}

// Gives what has arrived to the lanes that share it.
void RtUnit::hand_out(uint32_t index, Cycle now) {
  const Pipe pipe = pipe_for(fetches_[index]);
  Test test;
  if (pipe == kTriangle && fetches_[index].node.kind == NodeKind::Triangle) {
    TriangleLeaf leaf;
    std::memcpy(&leaf, memory_.find(fetches_[index].node.address, sizeof leaf), sizeof leaf);
    test.starts_left = leaf.count > 1 ? 2 : 1;
  }
  while (index != kNone) {
    const NodeFetch fetch = fetches_[index];
    free_fetches_.push_back(index);
    index = fetch.next;
    test.slot = fetch.slot;
    for_each_lane(fetch.lanes, [&](int lane) {
      test.lane = uint8_t(lane);
      if (fetch.part == Part::Fill)
        place(fetch.slot, lane, now);
      else
        pipes_[pipe].waiting.push(test);
    });
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
      const auto stores = uint8_t(visit(test, now));
      pipe.running.push({now + pipe.params.latency, test.slot, test.lane, stores});
      pipe.waiting.pop();
    }
  }
}

// The functional step: made when the test starts, seen by the unit when it ends. Returns how many stores it
// causes.
uint32_t RtUnit::visit(const Test& test, Cycle now) {
  Slot& slot = slots_[test.slot];
  const LaneMask lane_bit = LaneMask{1} << test.lane;
  const Part part = slot.part[test.lane];
  if (part == Part::Header) {
    slot.headers &= ~lane_bit;
    ++stats_.headers;
    return 0;
  }
  if (part == Part::Descriptor) {
    slot.described |= lane_bit;
    ++stats_.descriptors;
    return 0;
  }
  if (part == Part::Replay) {
    ++stats_.restart_nodes;
    return 0;
  }
  slot.described &= ~lane_bit;
  const Fetch& node = slot.node[test.lane];
  RayState& state = slot.states[test.lane];
  node_visited_.fire([&] { return NodeVisited{now, slot.warp, test.lane, node}; });
  const uint32_t boxes = state.box_tests, triangles = state.triangle_tests, hits = state.hits_in_interval;
  if (!params_.retest && state.stack[size_t(state.stack_size) - 1].t_enter > state.committed.t)
    ++stats_.stale_nodes;
  step(state, memory_.find(node.address, node.bytes));
  if (tends_stacks_) slot.stack[test.lane] = stack_model_->settle(state);
  stats_.box_tests += state.box_tests - boxes;
  stats_.triangle_tests += state.triangle_tests - triangles;
  count_node(node.kind);
  const bool has_entered = node.kind == NodeKind::Instance && state.bottom_stack_base >= 0;
  if (has_entered && params_.shortcuts.fetch_headers) slot.headers |= lane_bit;
  const uint32_t entries = state.table ? collect_entries(test.slot, test.lane) : 0;
  return params_.shortcuts.store_each_hit ? state.hits_in_interval - hits + 2 * entries : 0;
}

void RtUnit::count_node(NodeKind kind) {
  ++stats_.nodes;
  switch (kind) {
    case NodeKind::Internal:
      ++stats_.internal_nodes;
      break;
    case NodeKind::Instance:
      ++stats_.instance_leaves;
      break;
    case NodeKind::Triangle:
    case NodeKind::TriangleSecond:
      ++stats_.triangle_leaves;
      break;
    case NodeKind::Procedural:
      ++stats_.procedural_leaves;
      break;
  }
}

}  // namespace glint::rt
