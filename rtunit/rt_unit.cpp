// One cycle of the RT unit, back to front.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/rt_unit.h"

#include <algorithm>

#include "base/check.h"
#include "base/num_lanes.h"

namespace glint::rt {
namespace {

mem::Traffic traffic_of(NodeKind kind) {
  switch (kind) {
    case NodeKind::Internal: return mem::Traffic::RtNode;
    case NodeKind::Instance: return mem::Traffic::RtInstance;
    case NodeKind::Triangle:
    case NodeKind::TriangleSecond: return mem::Traffic::RtTriangle;
    case NodeKind::Procedural: return mem::Traffic::RtProcedural;
  }
  return mem::Traffic::RtNode;
}

}  // namespace

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
    if (states[lane].nodes_visited == 0) ++stats_.rays;
    else ++stats_.resumed;
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

// Sends what the port takes; results first, so that a finished warp is not kept by the others' nodes.
Stall RtUnit::send_requests(Cycle now) {
  bool sent = false;
  for (uint32_t i = 0; i < params_.requests_per_cycle; ++i) {
    if (sending_ == kNone && writing_.empty() && gathering_.empty() && !choose_fetch(now)) break;
    if (!send_next(now)) {
      ++stats_.refusals;
      return sent ? Stall::NodeRequest : Stall::L1Refused;
    }
    sent = true;
  }
  return sent ? Stall::NodeRequest : waiting_reason();
}

bool RtUnit::send_next(Cycle now) {
  if (sending_ != kNone) return send_node(now);
  return writing_.empty() ? send_entries(now) : send_result(now);
}

// Takes the node of the lowest wanting lane of the warp that the policy picks, for all lanes that want it.
bool RtUnit::choose_fetch(Cycle now) {
  bool any = false;
  for (size_t i = 0; i < slots_.size(); ++i) {
    const Slot& slot = slots_[i];
    const bool ready = slot.used && slot.wanting && slot.arrived < now;
    views_[i] = {ready, num_lanes(slot.wanting), slot.age, slot.arrived};
    any |= ready;
  }
  if (!any) return false;
  const uint32_t picked = scheduler_->pick(views_);
  GLINT_CHECK(picked < slots_.size() && views_[picked].ready, "scheduler '{}' picked slot {}, which is not ready",
              params_.scheduler.name, picked);
  Slot& slot = slots_[picked];
  sending_ = free_fetches_.back();
  free_fetches_.pop_back();
  NodeFetch& fetch = fetches_[sending_];
  fetch = {picked, 0, slot.node[size_t(std::countr_zero(slot.wanting))], 0, 0};
  for_each_lane(slot.wanting, [&](int lane) {
    const Fetch& node = slot.node[size_t(lane)];
    if (node.address == fetch.node.address && node.kind == fetch.node.kind) fetch.lanes |= LaneMask{1} << lane;
  });
  slot.wanting &= ~fetch.lanes;
  ++num_fetches_;
  ++stats_.fetches;
  stats_.merged_lanes += num_lanes(fetch.lanes) - 1;
  return true;
}

// The next sectors of the node being sent: no more than a request holds, and of one line. A node that begins within a
// sector takes the whole of it.
bool RtUnit::send_node(Cycle now) {
  NodeFetch& fetch = fetches_[sending_];
  const Address at = memory_.physical(fetch.node.address + fetch.sent);
  const Address offset = at & (l1_.line_bytes() - 1);
  const Address first = offset / mem::kSectorBytes, room = params_.request_bytes / mem::kSectorBytes;
  const Address end = std::min<Address>({offset + fetch.node.bytes - fetch.sent, (first + room) * mem::kSectorBytes, l1_.line_bytes()});
  const uint32_t count = uint32_t((end + mem::kSectorBytes - 1) / mem::kSectorBytes - first);
  mem::Request request;
  request.line = at - offset;
  request.sectors = uint8_t(((1u << count) - 1) << first);
  request.traffic = traffic_of(fetch.node.kind);
  request.token = sending_;
  if (!l1_.access(now, mem::Client::RtUnit, request)) return false;
  ++stats_.requests;
  stats_.sectors += count;
  ++fetch.unanswered;
  fetch.sent += uint32_t(end - offset);
  if (fetch.sent == fetch.node.bytes) sending_ = kNone;
  return true;
}

// Model: results are written as node traffic, 32 B a ray, one request a line; the warp is given back when the L1 has taken them.
bool RtUnit::send_result(Cycle now) {
  const uint32_t index = writing_.front();
  Slot& slot = slots_[index];
  const uint32_t lanes_a_line = l1_.line_bytes() / mem::kSectorBytes;
  const uint32_t first = uint32_t(std::countr_zero(slot.unwritten)) / lanes_a_line * lanes_a_line;
  const LaneMask in_line = slot.unwritten >> first & ((LaneMask{1} << lanes_a_line) - 1);
  mem::Request request;
  request.line = results_ + (Address(index) * kLanes + first) * mem::kSectorBytes;
  request.sectors = uint8_t(in_line);
  request.write = true;
  request.traffic = mem::Traffic::RtNode;
  if (!l1_.access(now, mem::Client::RtUnit, request)) return false;
  ++stats_.result_writes;
  slot.unwritten &= ~(in_line << first);
  if (slot.unwritten == 0) {
    writing_.pop();
    finished_.push(index);
  }
  return true;
}

// What a visit has put into the lane's table goes to memory.
void RtUnit::collect_entries(uint32_t slot_index, int lane) {
  Slot& slot = slots_[slot_index];
  CandidateTable& table = *slot.states[lane].table;
  const uint32_t added = tables_.rows ? table.unwritten & table.used : 0;
  table.unwritten = 0;
  if (!added) return;
  if (!slot.rows) gathering_.push(slot_index);
  for (uint32_t rest = added; rest; rest &= rest - 1) {
    const auto row = size_t(std::countr_zero(rest));
    if (!(slot.rows >> row & 1)) slot.entries[row] = 0;
    slot.entries[row] |= LaneMask{1} << lane;
  }
  slot.rows |= added;
}

// Lanes that have filled the same row share a request, if their entries lie in one line and are not yet sent.
bool RtUnit::send_entries(Cycle now) {
  const uint32_t index = gathering_.front();
  Slot& slot = slots_[index];
  const auto row = uint32_t(std::countr_zero(slot.rows));
  LaneMask& lanes = slot.entries[row];
  const uint32_t lanes_a_line = l1_.line_bytes() / kTableEntryBytes, first = uint32_t(std::countr_zero(lanes)) / lanes_a_line * lanes_a_line;
  const LaneMask in_line = lanes >> first & ((LaneMask{1} << lanes_a_line) - 1);
  mem::Request request;
  request.line = tables_.entry(slot.warp, row, int(first));
  request.sectors = uint8_t(in_line);
  request.write = true;
  request.traffic = mem::Traffic::RtTable;
  if (!l1_.access(now, mem::Client::RtUnit, request)) return false;
  ++stats_.table_writes;
  stats_.table_entries += num_lanes(in_line);
  lanes &= ~(in_line << first);
  if (lanes == 0) slot.rows &= ~(1u << row);
  if (slot.rows != 0) return true;
  gathering_.pop();
  leave(index);
  return true;
}

}  // namespace glint::rt
