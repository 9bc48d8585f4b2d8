// Chooses a node and asks the L1 for it.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/fetch_queue.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/check.h"
#include "base/num_lanes.h"

namespace glint::rt {
namespace {

// Gives the traffic of a node's requests, by NodeKind.
constexpr mem::Traffic kTraffic[] = {mem::Traffic::RtNode, mem::Traffic::RtInstance, mem::Traffic::RtTriangle,
                                     mem::Traffic::RtProcedural, mem::Traffic::RtTriangle};

}  // namespace

FetchQueue::FetchQueue(const Params& params, const mem::AddressSpace& memory, mem::L1Port& l1,
                       WarpBuffer& buffer, RtStats& stats)
    : max_reads_(params.mshr_entries),
      responses_per_cycle_(params.responses_per_cycle),
      request_bytes_(params.request_bytes),
      line_bytes_(l1.line_bytes()),
      always_hits_(params.oracle.fetch_hits),
      scheduler_name_(params.scheduler.name),
      memory_(memory),
      l1_(l1),
      buffer_(buffer),
      stats_(stats),
      treelets_(memory, buffer.size()),
      scheduler_(params.scheduler.make({&stats, buffer.size()})),
      coalescer_(params.coalescing.make({})),
      views_(buffer.size()),
      reads_(size_t{buffer.size()} * kLanes) {
  for (size_t i = reads_.size(); i-- > 0;) free_.push_back(uint32_t(i));
}

// The policy picks the warp, and perhaps the lane. Model: otherwise the lane with the lowest number among
// those that want a read is served first.
bool FetchQueue::choose(Cycle now) {
  if (is_full() || !buffer_.has_wanting_lanes() || !has_ready_warp(now)) return false;
  const auto [picked, lane] = scheduler_->choose(views_, *this);
  GLINT_CHECK(picked < views_.size() && views_[picked].ready,
              "scheduler '{}' picked slot {}, which is not ready", scheduler_name_, picked);
  const BufferSlot& slot = buffer_[picked];
  const auto first = size_t(lane < 0 ? std::countr_zero(slot.wanting) : lane);
  GLINT_CHECK(slot.wanting >> first & 1, "scheduler '{}' chose lane {} of slot {}, which wants no node",
              scheduler_name_, first, picked);
  const Read& read = slot.read[first];
  const uint64_t partners = coalescer_->partners(picked, views_);
  sending_ = add(picked, partners ? lanes_wanting(slot, read.what) : LaneMask{1} << first, read);
  prepare_request();
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

// Looks at the slots in which something has changed. A warp takes part from the cycle after its arrival on.
bool FetchQueue::has_ready_warp(Cycle now) {
  for (uint64_t rest = buffer_.take_changes(); rest; rest &= rest - 1) {
    const auto i = uint32_t(std::countr_zero(rest));
    const BufferSlot& slot = buffer_[i];
    const bool is_new = slot.arrived >= now, ready = slot.wanting && !is_new;
    views_[i] = {ready, num_lanes(slot.wanting), slot.age, slot.arrived};
    ready_ = (ready_ & ~(uint64_t{1} << i)) | uint64_t{ready} << i;
    if (is_new) [[unlikely]]
      buffer_.note_change(i);
  }
  return ready_ != 0;
}

LaneMask FetchQueue::lanes_wanting(const BufferSlot& slot, const Fetch& what) {
  const auto low = uint32_t(what.address);
  const FourBits wanted{low, low, low, low};
  LaneMask out = 0;
  for (int i = 0; i < kLanes; i += 4) {
    FourBits part;
    std::memcpy(&part, &slot.low_address[size_t(i)], sizeof part);
    out |= LaneMask{mask_of(part == wanted)} << i;
  }
  for_each_lane(out &= slot.wanting, [&](int lane) {
    if (slot.read[size_t(lane)].what != what) [[unlikely]]
      out &= ~(LaneMask{1} << lane);
  });
  return out;
}

uint32_t FetchQueue::add(uint32_t slot, LaneMask lanes, const Read& read) {
  const uint32_t index = free_.back();
  free_.pop_back();
  ReadInFlight& made = reads_[index];
  made.slot = slot;
  made.lanes = lanes;
  made.read.set(read.what, read.pipe, read.errand);
  made.sent = made.unanswered = 0;
  made.next = ReadInFlight::kNone;
  buffer_.serve(slot, lanes);
  return index;
}

// Makes the request for the next sectors of the node: at most what a request holds, and only sectors of one
// line. A node that begins within a sector takes the whole of it.
void FetchQueue::prepare_request() {
  const ReadInFlight& read = reads_[sending_];
  const Address at = memory_.physical(read.read.what.address + read.sent);
  const Address offset = at & (line_bytes_ - 1);
  const Address first = offset / mem::kSectorBytes, room = request_bytes_ / mem::kSectorBytes;
  const Address end = std::min<Address>(
      {offset + read.read.what.bytes - read.sent, (first + room) * mem::kSectorBytes, line_bytes_});
  num_sectors_ = uint32_t((end + mem::kSectorBytes - 1) / mem::kSectorBytes - first);
  num_bytes_ = uint32_t(end - offset);
  request_.line = at - offset;
  request_.sectors = uint8_t(((1u << num_sectors_) - 1) << first);
  request_.traffic = kTraffic[size_t(read.read.what.kind)];
  request_.token = sending_;
}

bool FetchQueue::ask(Cycle now) {
  if (!always_hits_) [[likely]]
    return l1_.access(now, mem::Client::RtUnit, request_);
  sure_hits_.push({now + l1_.hit_latency(), request_.token});
  return true;
}

bool FetchQueue::send(Cycle now) {
  if (!ask(now)) return false;
  ++stats_.requests;
  stats_.sectors += num_sectors_;
  ReadInFlight& read = reads_[sending_];
  if (listener_) [[unlikely]]
    listener_->demanded(read.read.what.address + read.sent, num_bytes_, now);
  ++read.unanswered;
  read.sent += num_bytes_;
  if (read.sent == read.read.what.bytes)
    sending_ = ReadInFlight::kNone;
  else
    prepare_request();
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
