// What the L1 does with accesses, departures and fills.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/l1_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace glint::mem {
namespace {

uint32_t num_ways(uint64_t size, uint32_t ways, uint32_t line) { return ways ? ways : uint32_t(size / line); }

}  // namespace

L1Cache::L1Cache(const Params& params, uint16_t core, const PartitionMap& map, std::vector<FanIn<Packet>*> requests,
                 FanIn<Reply>* replies, stats::Group* parent)
    : params_(params.l1),
      line_bytes_(params.line),
      core_(core),
      map_(map),
      requests_(std::move(requests)),
      replies_(replies),
      stats_(parent),
      tags_(uint32_t(params_.size / line_bytes_) / num_ways(params_.size, params_.ways, line_bytes_),
            num_ways(params_.size, params_.ways, line_bytes_), line_bytes_),
      mshr_(params_.mshr_entries, params_.mshr_merges),
      passing_(params_.mshr_entries),
      miss_queue_(params_.miss_queue),
      request_port_(params.noc.core_request_bytes),
      reply_port_(params.noc.core_reply_bytes),
      partition_reply_port_(params.noc.partition_reply_bytes),
      request_latency_(params.noc.request_latency) {}

bool L1Cache::refuse(Refusal reason) {
  stats_.refusals.add(reason);
  return false;
}

bool L1Cache::access(Cycle now, Client client, const Request& request) {
  GLINT_DCHECK(request.sectors != 0 && request.line % line_bytes_ == 0, "line {:#x}", request.line);
  if (passes_l1(request.traffic) && !request.write) return read(now, client, request);
  if (now != port_cycle_) port_cycle_ = now, accesses_ = 0, busy_banks_ = 0;
  if (accesses_ == params_.ports) return refuse(Refusal::Port);
  const uint64_t bank = uint64_t{1} << (params_.banks == 1 ? 0 : request.line / line_bytes_ % params_.banks);
  if (busy_banks_ & bank) return refuse(Refusal::Bank);
  const bool local = params_.local_write_back && request.traffic == Traffic::ShaderLocal;
  const bool taken = request.traffic == Traffic::ShaderAtomic ? pass_atomic(now, client, request)
                     : !request.write                         ? read(now, client, request)
                     : local                                  ? write_local(now, request)
                                                              : write_through(now, request);
  if (!taken) return false;
  ++accesses_;
  busy_banks_ |= bank;
  return true;
}

bool L1Cache::read(Cycle now, Client client, const Request& request) {
  const uint32_t slot = tags_.find(request.line);
  const uint8_t missing = slot == kNone ? request.sectors : uint8_t(request.sectors & ~tags_.line(slot).valid);
  uint8_t fetched = 0;
  if (missing == 0) {
    answers_[size_t(client)].hits.push({now + params_.hit_latency, order_, request.token});
  } else {
    uint32_t entry = mshr_.find(request.line);
    if (entry == kNone && mshr_.full()) return refuse(Refusal::MshrFull);
    if (entry != kNone && mshr_.merge_limit(entry)) return refuse(Refusal::MergeLimit);
    fetched = entry == kNone ? missing : uint8_t(missing & ~mshr_.pending(entry));
    if (fetched && queue_full()) return refuse(Refusal::QueueFull);
    if (entry == kNone) {
      entry = mshr_.allocate(request.line);
      passing_[entry] = true;
    }
    passing_[entry] &= uint8_t{passes_l1(request.traffic)};
    mshr_.expect(entry, fetched);
    mshr_.add(entry, {now, order_, request.token, missing, client});
    if (fetched) {
      queue_packet(now + params_.miss_latency, request.line, fetched, false, request.traffic);
      sectors_requested_ += num_sectors(fetched);
    }
  }
  if (slot != kNone) tags_.touch(slot);
  ++order_;
  ++reads_accepted_;
  stats_.count_read(request.traffic, missing, fetched, request.line, seen_);
  return true;
}

// Write-through without allocation: sectors that are present stay valid, with the new bytes.
bool L1Cache::write_through(Cycle now, const Request& request) {
  if (queue_full()) return refuse(Refusal::QueueFull);
  const uint32_t slot = tags_.find(request.line);
  if (slot != kNone) {
    tags_.touch(slot);
    stats_.write_hits.add(request.traffic);
  }
  stats_.writes.add(request.traffic);
  queue_packet(now + params_.miss_latency, request.line, request.sectors, true, request.traffic);
  return true;
}

// Counted as a miss: nothing of it is looked up here.
bool L1Cache::pass_atomic(Cycle now, Client client, const Request& request) {
  if (queue_full()) return refuse(Refusal::QueueFull);
  const uint32_t slot = tags_.find(request.line);
  if (slot != kNone) tags_.drop(slot, request.sectors);
  queue_packet(now + params_.miss_latency, request.line, request.sectors, request.write, request.traffic, request.token, client);
  if (request.write) {
    stats_.writes.add(request.traffic);
    return true;
  }
  ++order_;
  ++reads_accepted_;
  sectors_requested_ += num_sectors(request.sectors);
  stats_.reads.add(request.traffic);
  stats_.misses.add(request.traffic);
  stats_.sectors_fetched.add(request.traffic, num_sectors(request.sectors));
  return true;
}

// Write-back with write-validate: whole sectors are written, so nothing needs to be fetched.
bool L1Cache::write_local(Cycle now, const Request& request) {
  const uint32_t slot = tags_.find(request.line);
  if (slot == kNone) {
    const TagArray::Line& victim = tags_.victim(request.line);
    if (victim.dirty && queue_full()) return refuse(Refusal::QueueFull);
    evict(now, victim);
  } else {
    tags_.touch(slot);
    stats_.write_hits.add(request.traffic);
  }
  TagArray::Line& line = slot == kNone ? tags_.insert(request.line) : tags_.line(slot);
  line.valid |= request.sectors;
  line.dirty |= request.sectors;
  seen_.insert_if_new(request.line);
  stats_.writes.add(request.traffic);
  return true;
}

void L1Cache::queue_packet(Cycle ready, Address line, uint8_t sectors, bool write, Traffic traffic, Token token,
                           Client client) {
  // A write-back of a fill is ready at once and may not overtake; the queue is in order, so it waits for those before it.
  miss_queue_.push({ready, {line, core_, sectors, write, traffic, token, client, order_}});
}

void L1Cache::evict(Cycle now, const TagArray::Line& victim) {
  if (!victim.valid) return;
  ++stats_.evictions;
  if (!victim.dirty) return;
  ++stats_.write_backs;
  queue_packet(now, victim.address, victim.dirty, true, Traffic::ShaderLocal);
}

std::optional<Token> L1Cache::pop(Cycle now, Client client) {
  Answers& a = answers_[size_t(client)];
  const bool hit = !a.hits.empty() && a.hits.front().ready <= now;
  const bool fill = !a.fills.empty() && a.fills.front().ready <= now;
  if (!hit && !fill) return std::nullopt;
  bool take_hit = hit;
  if (hit && fill) {
    const Completion &h = a.hits.front(), &f = a.fills.front();
    take_hit = h.ready != f.ready ? h.ready < f.ready : h.order < f.order;
  }
  Ring<Completion>& ring = take_hit ? a.hits : a.fills;
  const Token token = ring.front().token;
  ring.pop();
  ++tokens_returned_;
  return token;
}

Cycle L1Cache::next_departure() const {
  return miss_queue_.empty() ? kNever : std::max(miss_queue_.front().ready, request_port_.free_at());
}

Cycle L1Cache::next_fill() const {
  if (replies_->arrival() == kNever) return kNever;
  const uint32_t bytes = bytes_of(replies_->front());
  return std::max(reply_port_.received_at(replies_->arrival(), partition_reply_port_.cycles(bytes), bytes), fill_not_before_);
}

void L1Cache::tick(Cycle now) {
  for (;;) {
    const Cycle departure = next_departure(), arrival = next_fill();
    if (std::min(departure, arrival) > now) return;
    if (departure <= arrival) {  // departures first: a place in the queue freed this cycle can take a write-back
      send_front(departure);
    } else if (!fill(arrival)) {
      fill_not_before_ = next_departure();
    }
  }
}

void L1Cache::send_front(Cycle now) {
  Outgoing& out = miss_queue_.front();
  out.packet.stamps.set(Stage::L1Queue, now);
  stats_.request_wait += now - out.ready;
  const uint32_t bytes = bytes_of(out.packet);
  const Cycle tail = request_port_.leave(now, bytes);
  requests_[map_.partition(out.packet.line)]->send(core_, tail + request_latency_, out.packet);
  stats_.request_bytes += bytes;
  ++packets_sent_;
  miss_queue_.pop();
}

// Takes the oldest reply; false when it needs a place in the cache and its dirty victim finds none in the miss queue.
bool L1Cache::fill(Cycle now) {
  const Reply reply = replies_->front();
  if (!reply.is_atomic && !passing_[mshr_.find(reply.line)] && !place(now, reply)) return false;
  const uint32_t bytes = bytes_of(reply);
  ++stats_.fills;
  stats_.reply_bytes += bytes;
  stats_.reply_wait += now - replies_->arrival();
  sectors_received_ += num_sectors(reply.sectors);
  reply_port_.occupy_until(reply_port_.received_at(replies_->arrival(), partition_reply_port_.cycles(bytes), bytes));
  replies_->pop();
  fill_not_before_ = now + 1;
  if (reply.is_atomic)
    answers_[size_t(reply.client)].fills.push({now, reply.order, reply.token});
  else
    answer_waiters(now, reply);
  return true;
}

bool L1Cache::place(Cycle now, const Reply& reply) {
  const uint32_t slot = tags_.find(reply.line);
  if (slot == kNone) {
    const TagArray::Line& victim = tags_.victim(reply.line);
    if (victim.dirty && queue_full()) return false;
    evict(now, victim);
  }
  TagArray::Line& line = slot == kNone ? tags_.insert(reply.line) : tags_.line(slot);
  line.valid |= reply.sectors;
  return true;
}

void L1Cache::answer_waiters(Cycle now, const Reply& reply) {
  mshr_.arrive(mshr_.find(reply.line), reply.sectors, [&](Waiter& waiter) {
    waiter.missing &= uint8_t(~reply.sectors);
    if (waiter.missing) return false;
    answers_[size_t(waiter.client)].fills.push({now, waiter.order, waiter.token});
    count_miss(waiter.accepted, now, reply.stamps);
    return true;
  });
}

void L1Cache::count_miss(Cycle accepted, Cycle now, const Stamps& stamps) {
  const Cycle latency = now - accepted;
  const bool from_dram = stamps.end[size_t(Stage::DramService)] != stamps.end[size_t(Stage::L2Service)];
  stats_.miss_latency.add(latency);
  (from_dram ? stats_.dram_latency : stats_.l2_latency).add(latency);
  ++stats_.timed_misses;
  stats_.miss_cycles += latency;
  add_stages(stats_.miss_stages, accepted, now, stamps);
}

Cycle L1Cache::next_event(Cycle now) const {
  Cycle next = std::min(next_departure(), next_fill());
  for (const Answers& a : answers_) {
    if (!a.hits.empty()) next = std::min(next, a.hits.front().ready);
    if (!a.fills.empty()) next = std::min(next, a.fills.front().ready);
  }
  return next == kNever ? kNever : std::max(next, now);
}

std::string L1Cache::describe() const {
  std::string out;
  if (reads_accepted_ != tokens_returned_)
    out += fmt::format("  L1: {} reads without an answer, {} lines on the way, {} of {} sectors have come\n", reads_accepted_ - tokens_returned_,
                       mshr_.in_use(), sectors_received_, sectors_requested_);
  if (!miss_queue_.empty()) {
    const Packet& first = miss_queue_.front().packet;
    out += fmt::format("  L1: {} packets wait to leave, the first {} line {:#x} for partition {}\n", miss_queue_.size(), first.write ? "writes" : "reads",
                       first.line, map_.partition(first.line));
  }
  return out;
}

bool L1Cache::drained() const {
  return miss_queue_.empty() && mshr_.in_use() == 0 && tokens_returned_ == reads_accepted_ &&
         sectors_requested_ == sectors_received_;
}

}  // namespace glint::mem
