// Chooses a node and asks the L1 for it.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/fetch_queue.h"

#include <algorithm>
#include <bit>

#include "base/check.h"
#include "base/num_lanes.h"

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

FetchQueue::FetchQueue(const Params& params, const mem::AddressSpace& memory, mem::L1Port& l1,
                       WarpBuffer& buffer, RtStats& stats)
    : max_reads_(params.mshr_entries),
      responses_per_cycle_(params.responses_per_cycle),
      request_bytes_(params.request_bytes),
      scheduler_name_(params.scheduler.name),
      memory_(memory),
      l1_(l1),
      buffer_(buffer),
      stats_(stats),
      scheduler_(params.scheduler.make({&stats})),
      coalescer_(params.coalescing.make({})),
      views_(params.warps),
      reads_(size_t(params.warps) * kLanes) {
  for (size_t i = reads_.size(); i-- > 0;) free_.push_back(uint32_t(i));
}

Cycle FetchQueue::next_event(Cycle now) const {
  return has_request(now) || (!is_full() && has_reads_waiting()) ? now + 1 : kNever;
}

// The policy picks the warp. Model: among its lanes that want a read, the one with the lowest number is
// served first.
bool FetchQueue::choose(Cycle now) {
  if (is_full() || !buffer_.has_wanting_lanes()) return false;
  bool any = false;
  for (uint32_t i = 0; i < buffer_.size(); ++i) {
    const BufferSlot& slot = buffer_[i];
    const bool ready = slot.is_used && slot.wanting && slot.arrived < now;
    views_[i] = {ready, num_lanes(slot.wanting), slot.age, slot.arrived};
    any |= ready;
  }
  if (!any) return false;
  const uint32_t picked = scheduler_->pick(views_);
  GLINT_CHECK(picked < views_.size() && views_[picked].ready,
              "scheduler '{}' picked slot {}, which is not ready", scheduler_name_, picked);
  const BufferSlot& slot = buffer_[picked];
  const auto first = size_t(std::countr_zero(slot.wanting));
  const Read read = slot.read[first];
  const uint64_t partners = coalescer_->partners(picked, views_);
  sending_ = add(picked, partners ? lanes_wanting(slot, read.what) : LaneMask{1} << first, read);
  ++num_reads_;
  ++stats_.fetches;
  stats_.merged_lanes += num_lanes(reads_[sending_].lanes) - 1;
  uint32_t last = sending_;
  for (uint64_t others = partners & ~(uint64_t{1} << picked); others; others &= others - 1) {
    const auto other = uint32_t(std::countr_zero(others));
    const LaneMask lanes = lanes_wanting(buffer_[other], read.what);
    if (!lanes) continue;
    last = reads_[last].next = add(other, lanes, read);
    stats_.merged_lanes += num_lanes(lanes);
    stats_.merged_across += num_lanes(lanes);
  }
  return true;
}

LaneMask FetchQueue::lanes_wanting(const BufferSlot& slot, const Fetch& what) {
  LaneMask out = 0;
  for_each_lane(slot.wanting,
                [&](int lane) { out |= LaneMask{slot.read[size_t(lane)].what == what} << lane; });
  return out;
}

uint32_t FetchQueue::add(uint32_t slot, LaneMask lanes, const Read& read) {
  const uint32_t index = free_.back();
  free_.pop_back();
  reads_[index] = {slot, lanes, read};
  buffer_.serve(slot, lanes);
  return index;
}

// Sends the next sectors of the node: at most what a request holds, and only sectors of one line. A node that
// begins within a sector takes the whole of it.
bool FetchQueue::send(Cycle now) {
  ReadInFlight& read = reads_[sending_];
  const uint32_t bytes = read.read.what.bytes;
  const Address at = memory_.physical(read.read.what.address + read.sent);
  const Address offset = at & (l1_.line_bytes() - 1);
  const Address first = offset / mem::kSectorBytes, room = request_bytes_ / mem::kSectorBytes;
  const Address end =
      std::min<Address>({offset + bytes - read.sent, (first + room) * mem::kSectorBytes, l1_.line_bytes()});
  const uint32_t count = uint32_t((end + mem::kSectorBytes - 1) / mem::kSectorBytes - first);
  mem::Request request;
  request.line = at - offset;
  request.sectors = uint8_t(((1u << count) - 1) << first);
  request.traffic = traffic_of(read.read.what.kind);
  request.token = sending_;
  if (!l1_.access(now, mem::Client::RtUnit, request)) return false;
  ++stats_.requests;
  stats_.sectors += count;
  ++read.unanswered;
  read.sent += uint32_t(end - offset);
  if (read.sent == bytes) sending_ = ReadInFlight::kNone;
  return true;
}

mem::Token FetchQueue::open(uint32_t slot, int lane) {
  const uint32_t index = add(slot, LaneMask{1} << lane, {{}, nullptr, kNoPipe});
  reads_[index].unanswered = 1;
  ++num_reads_;
  return index;
}

void FetchQueue::cancel(mem::Token token) {
  free_.push_back(uint32_t(token));
  --num_reads_;
}

}  // namespace glint::rt
