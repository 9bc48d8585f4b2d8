// What an RT unit sends to its L1: nodes, results, entries of candidate tables.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "base/check.h"
#include "base/num_lanes.h"
#include "rtunit/unit/rt_unit.h"

namespace glint::rt {
namespace {

mem::Traffic traffic_of(NodeKind kind) {
  switch (kind) {
    case NodeKind::Internal:
      return mem::Traffic::RtNode;
    case NodeKind::Instance:
      return mem::Traffic::RtInstance;
    case NodeKind::Triangle:
    case NodeKind::TriangleSecond:
      return mem::Traffic::RtTriangle;
    case NodeKind::Procedural:
      return mem::Traffic::RtProcedural;
  }
  return mem::Traffic::RtNode;
}

}  // namespace

// Sends what the port takes; results first, so that a finished warp is not kept by the others' nodes.
Stall RtUnit::send_requests(Cycle now) {
  bool sent = false;
  for (uint32_t i = 0; i < params_.requests_per_cycle; ++i) {
    const bool has_other =
        sending_ != kNone || num_stores_ || can_send_stack(now) || !writing_.empty() || !gathering_.empty();
    if (!has_other && !choose_fetch(now)) break;
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
  if (num_stores_) return send_hit(now);
  if (can_send_stack(now)) return send_stack(now);
  return writing_.empty() ? send_entries(now) : send_result(now);
}

// Takes the node of the lowest wanting lane of the warp that the policy picks, for all lanes that want it and
// share.
bool RtUnit::choose_fetch(Cycle now) {
  if (is_mshr_full()) return false;
  bool any = false;
  for (size_t i = 0; i < slots_.size(); ++i) {
    const Slot& slot = slots_[i];
    const bool ready = slot.used && slot.wanting && slot.arrived < now;
    views_[i] = {ready, num_lanes(slot.wanting), slot.age, slot.arrived};
    any |= ready;
  }
  if (!any) return false;
  const uint32_t picked = scheduler_->pick(views_);
  GLINT_CHECK(picked < slots_.size() && views_[picked].ready,
              "scheduler '{}' picked slot {}, which is not ready", params_.scheduler.name, picked);
  Slot& slot = slots_[picked];
  const auto first = size_t(std::countr_zero(slot.wanting));
  const Fetch node = slot.node[first];
  const uint64_t partners = coalescer_->partners(picked, views_);
  sending_ =
      new_fetch(picked, partners ? lanes_wanting(slot, node) : LaneMask{1} << first, node, slot.part[first]);
  ++num_fetches_;
  ++stats_.fetches;
  stats_.merged_lanes += num_lanes(fetches_[sending_].lanes) - 1;
  uint32_t last = sending_;
  for (uint64_t others = partners & ~(uint64_t{1} << picked); others; others &= others - 1) {
    const auto other = uint32_t(std::countr_zero(others));
    const LaneMask lanes = lanes_wanting(slots_[other], node);
    if (!lanes) continue;
    last = fetches_[last].next = new_fetch(other, lanes, node, slot.part[first]);
    stats_.merged_lanes += num_lanes(lanes);
    stats_.merged_across += num_lanes(lanes);
  }
  return true;
}

LaneMask RtUnit::lanes_wanting(const Slot& slot, const Fetch& wanted) {
  LaneMask out = 0;
  for_each_lane(slot.wanting, [&](int lane) {
    const Fetch& node = slot.node[size_t(lane)];
    out |= LaneMask{node.address == wanted.address && node.kind == wanted.kind && node.bytes == wanted.bytes}
           << lane;
  });
  return out;
}

uint32_t RtUnit::new_fetch(uint32_t slot, LaneMask lanes, const Fetch& node, Part part) {
  const uint32_t index = free_fetches_.back();
  free_fetches_.pop_back();
  fetches_[index] = {slot, lanes, node, part, 0, 0, kNone};
  slots_[slot].wanting &= ~lanes;
  return index;
}

// The next sectors of the node being sent: no more than a request holds, and of one line. A node that begins
// within a sector takes the whole of it.
bool RtUnit::send_node(Cycle now) {
  NodeFetch& fetch = fetches_[sending_];
  const Address at = memory_.physical(fetch.node.address + fetch.sent);
  const Address offset = at & (l1_.line_bytes() - 1);
  const Address first = offset / mem::kSectorBytes, room = params_.request_bytes / mem::kSectorBytes;
  const Address end = std::min<Address>(
      {offset + fetch.node.bytes - fetch.sent, (first + room) * mem::kSectorBytes, l1_.line_bytes()});
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

// Model: results are written as node traffic, 32 B a ray, one request a line; the warp is given back when the
// L1 has taken them.
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

// One hit, at a place of its own. Model: which lane's it is makes no difference; the oldest warp sends first.
bool RtUnit::send_hit(Cycle now) {
  uint32_t index = kNone;
  for (uint32_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].stores && (index == kNone || slots_[i].age < slots_[index].age)) index = i;
  mem::Request request;
  request.line = results_ + Address(next_hit_place_) * kHitPlaceBytes;
  request.sectors = 1;
  request.write = true;
  request.traffic = mem::Traffic::RtNode;
  if (!l1_.access(now, mem::Client::RtUnit, request)) return false;
  ++stats_.hit_writes;
  next_hit_place_ = (next_hit_place_ + 1) % kHitPlaces;
  Slot& slot = slots_[index];
  --slot.stores;
  --num_stores_;
  slot.last_store = now;
  leave(index, now);
  return true;
}

// What a visit has put into the lane's table goes to memory. Returns the number of entries, when single
// stores carry them.
uint32_t RtUnit::collect_entries(uint32_t slot_index, int lane) {
  Slot& slot = slots_[slot_index];
  CandidateTable& table = *slot.states[lane].table;
  const uint32_t added = tables_.rows ? table.unwritten & table.used : 0;
  table.unwritten = 0;
  if (params_.shortcuts.store_each_hit) return uint32_t(std::popcount(added));
  if (!added) return 0;
  if (!slot.rows) gathering_.push(slot_index);
  for (uint32_t rest = added; rest; rest &= rest - 1) {
    const auto row = size_t(std::countr_zero(rest));
    if (!(slot.rows >> row & 1)) slot.entries[row] = 0;
    slot.entries[row] |= LaneMask{1} << lane;
  }
  slot.rows |= added;
  return 0;
}

// Lanes that have filled the same row share a request, if their entries lie in one line and are not yet sent.
bool RtUnit::send_entries(Cycle now) {
  const uint32_t index = gathering_.front();
  Slot& slot = slots_[index];
  const auto row = uint32_t(std::countr_zero(slot.rows));
  LaneMask& lanes = slot.entries[row];
  const uint32_t lanes_a_line = l1_.line_bytes() / kTableEntryBytes,
                 first = uint32_t(std::countr_zero(lanes)) / lanes_a_line * lanes_a_line;
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
  leave(index, now);
  return true;
}

}  // namespace glint::rt
