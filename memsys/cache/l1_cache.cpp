// Handles the accesses of the L1, the packets that leave it, and its fills.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/cache/l1_cache.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>

namespace glint::mem {

L1Cache::L1Cache(const Params& params, uint16_t core, const PartitionMap& map, CorePort port,
                 stats::Group* parent)
    : params_(params.l1),
      line_bytes_(params.line),
      line_shift_(uint32_t(std::countr_zero(params.line))),
      core_(core),
      allocate_on_miss_(params.l1.allocate == "on_miss"),
      map_(map),
      port_(std::move(port)),
      stats_(parent),
      tags_(cache_shape(params_.size, params_.ways, line_bytes_), params_.replacement),
      mshr_(params_.mshr_entries, params_.mshr_merges),
      passing_(params_.mshr_entries),
      prefetched_(tags_.num_lines(), params_.mshr_entries, stats_.prefetch),
      seen_(line_bytes_),
      miss_queue_(params_.miss_queue) {
  set_input(port_.arrival());
  find_due();
}

bool L1Cache::refuse(Refusal reason) {
  stats_.refusals.add(reason);
  return false;
}

bool L1Cache::access(Cycle now, Client client, const Request& request) {
  GLINT_DCHECK(request.sectors != 0 && request.line % line_bytes_ == 0, "line {:#x}", request.line);
  if (passes_l1(request.traffic) && !request.write) [[unlikely]]
    return read(now, client, request);
  if (now != port_cycle_) port_cycle_ = now, accesses_ = 0, busy_banks_ = 0;
  if (accesses_ == params_.ports) return refuse(Refusal::Port);
  const uint64_t bank = bank_of(request.line);
  if (busy_banks_ & bank) [[unlikely]]
    return refuse(Refusal::Bank);
  if (filled_cycle_ == now && (filled_bank_ & bank) && params_.fill_takes_access) [[unlikely]]
    return refuse(Refusal::Bank);
  if (!take(now, client, request)) return false;
  ++accesses_;
  busy_banks_ |= bank;
  return true;
}

inline bool L1Cache::take(Cycle now, Client client, const Request& request) {
  if (request.traffic == Traffic::ShaderAtomic) [[unlikely]]
    return pass_atomic(now, client, request);
  if (!request.write) [[likely]]
    return read(now, client, request);
  const bool keeps = is_local(request.traffic) ? params_.local_write_back : params_.global_write_back;
  return keeps ? write_back(now, client, request) : write_through(now, client, request);
}

// Choice: a prefetch that finds its line leaves the order of replacement as it is.
inline void L1Cache::count_read(const Request& request, uint32_t slot, uint8_t missing, uint8_t fetched) {
  if (request.traffic != Traffic::RtPrefetch) [[likely]] {
    if (slot != kNone) tags_.touch(slot);
    ++order_;
    ++reads_accepted_;
  }
  stats_.count_read(request.traffic, missing, fetched, request.line, seen_);
}

bool L1Cache::read(Cycle now, Client client, const Request& request) {
  const uint32_t slot = tags_.find(request.line);
  const uint8_t missing =
      slot == kNone ? request.sectors : uint8_t(request.sectors & ~tags_.line(slot).valid);
  if (missing) return miss(now, client, request, slot, missing);
  if (request.traffic != Traffic::RtPrefetch) [[likely]] {
    answer(client, true, {now + params_.hit_latency, order_, request.token});
    latencies_.add(request.traffic, params_.hit_latency);
    prefetched_.used(slot, request.sectors);
  }
  count_read(request, slot, 0, 0);
  return true;
}

// Handles a read with `missing` sectors, which may be on their way. Its line is in `slot` or absent.
bool L1Cache::miss(Cycle now, Client client, const Request& request, uint32_t slot, uint8_t missing) {
  uint32_t entry = mshr_.find(request.line);
  if (entry == kNone && mshr_.full()) return refuse(Refusal::MshrFull);
  const bool has_waiter = request.traffic != Traffic::RtPrefetch;
  if (entry != kNone && has_waiter && mshr_.merge_limit(entry)) return refuse(Refusal::MergeLimit);
  const uint8_t fetched = entry == kNone ? missing : uint8_t(missing & ~mshr_.pending(entry));
  if (fetched && queue_full()) return refuse(Refusal::QueueFull);
  if (allocate_on_miss_ && !passes_l1(request.traffic)) {
    if (slot == kNone && !tags_.has_victim(request.line)) return refuse(Refusal::SetHeld);
    const uint32_t packets = (fetched ? 1 : 0) + (slot == kNone && tags_.victim(request.line).dirty ? 1 : 0);
    if (!queue_room(packets)) return refuse(Refusal::QueueFull);
    hold(now, client, request, slot);
  }
  if (entry == kNone) {
    entry = mshr_.allocate(request.line);
    passing_[entry] = true;
  }
  passing_[entry] &= uint8_t{passes_l1(request.traffic)};
  mshr_.expect(entry, fetched);
  if (has_waiter) {
    mshr_.add(entry, {now, order_, request.token, missing, client, request.traffic});
    if (slot != kNone) prefetched_.used(slot, uint8_t(request.sectors & ~missing));
    prefetched_.awaited(entry, missing);
  } else {
    prefetched_.sent(entry, fetched);
  }
  if (fetched) {
    queue_packet(now + params_.miss_latency,
                 {.line = request.line, .sectors = fetched, .traffic = request.traffic});
    sectors_requested_ += num_sectors(fetched);
  }
  count_read(request, slot, missing, fetched);
  if (fetched && has_waiter) read_missed_.fire([&] { return ReadMissed{client, request}; });
  return true;
}

// Puts a line that `by` has asked for in the place of another one.
[[gnu::always_inline]] inline TagArray::Line& L1Cache::replace(Cycle now, Address line, Requester by) {
  const TagArray::Line& victim = tags_.victim(line);
  line_replaced_.fire([&] {
    return LineReplaced{tags_.slot_of(victim), by,
                        victim.used() ? std::optional(victim.address()) : std::nullopt};
  });
  evict(now, victim);
  return tags_.insert(line);
}

// Holds a line for data on their way, and evicts another line for it when the line is absent.
void L1Cache::hold(Cycle now, Client client, const Request& request, uint32_t slot) {
  (slot == kNone ? replace(now, request.line, {client, request.token}) : tags_.line(slot)).held = true;
}

// Writes a request through to the L2. Sectors that are present stay valid, with the new bytes. With
// `write_allocate`, a line that is absent is allocated with the sectors that the write covers.
bool L1Cache::write_through(Cycle now, Client client, const Request& request) {
  const uint32_t slot = tags_.find(request.line);
  const uint8_t covered = params_.write_allocate ? covered_sectors(request, line_bytes_) : uint8_t{0};
  const bool allocates = slot == kNone && covered && tags_.has_victim(request.line);
  const bool evicts_dirty = allocates && tags_.victim(request.line).dirty;
  if (!queue_room(evicts_dirty ? 2 : 1)) return refuse(Refusal::QueueFull);
  if (slot != kNone) {
    tags_.touch(slot);
    stats_.write_hits.add(request.traffic);
    if (params_.write_evict) {
      tags_.drop(slot, request.sectors);
      prefetched_.forget(slot, request.sectors);
    }
  }
  if (allocates)
    replace(now, request.line, {client, request.token}).valid = covered;
  else if (slot != kNone && covered && !params_.write_evict)
    tags_.line(slot).valid |= covered;
  stats_.writes.add(request.traffic);
  queue_packet(now + params_.miss_latency, {.line = request.line,
                                            .sectors = request.sectors,
                                            .write = true,
                                            .traffic = request.traffic,
                                            .words = request.words});
  return true;
}

// Sends an atomic to the L2. It counts as a miss, because the L1 looks nothing up for it.
bool L1Cache::pass_atomic(Cycle now, Client client, const Request& request) {
  if (queue_full()) return refuse(Refusal::QueueFull);
  const uint32_t slot = tags_.find(request.line);
  if (slot != kNone) {
    tags_.drop(slot, request.sectors);
    prefetched_.forget(slot, request.sectors);
  }
  queue_packet(now + params_.miss_latency, {.line = request.line,
                                            .sectors = request.sectors,
                                            .write = request.write,
                                            .traffic = request.traffic,
                                            .atomic = request.atomic,
                                            .token = request.token,
                                            .client = client,
                                            .order = order_,
                                            .stamps = {.accepted = uint32_t(now)}});
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
  read_missed_.fire([&] { return ReadMissed{client, request}; });
  return true;
}

// Writes a request into the cache, which writes it back later. Whole sectors are written, so nothing needs to
// be fetched (write-validate).
bool L1Cache::write_back(Cycle now, Client client, const Request& request) {
  const uint32_t slot = tags_.find(request.line);
  if (slot == kNone) {
    if (!tags_.has_victim(request.line)) return refuse(Refusal::SetHeld);
    if (tags_.victim(request.line).dirty && queue_full()) return refuse(Refusal::QueueFull);
  } else {
    tags_.touch(slot);
    stats_.write_hits.add(request.traffic);
  }
  TagArray::Line& line =
      slot == kNone ? replace(now, request.line, {client, request.token}) : tags_.line(slot);
  line.valid |= request.sectors;
  line.dirty |= request.sectors;
  seen_.insert_if_new(request.line);
  stats_.writes.add(request.traffic);
  return true;
}

void L1Cache::queue_packet(Cycle ready, const Packet& packet) {
  // The write-back of a fill is ready at once, but it may not overtake packets: the queue keeps its order.
  if (miss_queue_.empty() && !port_.has_credits()) set_due(ready);
  miss_queue_.push({ready, packet});
  miss_queue_.back().packet.core = core_;
  miss_queue_.back().packet.slice = uint16_t(map_.slice(packet.line));
}

void L1Cache::evict(Cycle now, const TagArray::Line& victim) {
  prefetched_.forget(tags_.slot_of(victim), victim.valid);
  if (!victim.used()) return;
  ++stats_.evictions;
  if (!victim.dirty) return;
  ++stats_.write_backs;
  const Traffic traffic = params_.global_write_back ? Traffic::ShaderGlobal : Traffic::ShaderLocal;
  queue_packet(now, {.line = victim.address(), .sectors = victim.dirty, .write = true, .traffic = traffic});
}

// Takes the answer that is ready first; of two that are ready in the same cycle, the one accepted first.
Token L1Cache::Answers::pop() {
  bool is_hit = fills.empty();
  if (!hits.empty() && !fills.empty()) {
    const Completion &h = hits.front(), &f = fills.front();
    is_hit = h.ready != f.ready ? h.ready < f.ready : h.order < f.order;
  }
  Ring<Completion>& ring = is_hit ? hits : fills;
  const Token token = ring.front().token;
  ring.pop();
  return token;
}

void L1Cache::answer(Client client, bool is_hit, const Completion& completion) {
  Answers& answers = answers_[size_t(client)];
  (is_hit ? answers.hits : answers.fills).push(completion);
  set_answer_at(client, std::min(answer_at(client), completion.ready));
}

Token L1Cache::take_answer(Client client) {
  ++tokens_returned_;
  Answers& answers = answers_[size_t(client)];
  const Token token = answers.pop();
  set_answer_at(client, answers.first());
  return token;
}

Cycle L1Cache::next_departure() const {
  if (miss_queue_.empty()) return kNever;
  return port_.departure(miss_queue_.front().ready, miss_queue_.front().packet.slice);
}

Cycle L1Cache::next_fill() const {
  if (fill_blocked_ || port_.arrival() == kNever) return kNever;
  return std::max(port_.received(), fill_not_before_);
}

// Finds when a packet may leave. With credits, the port looks for itself in every cycle.
void L1Cache::find_due() {
  set_due(port_.has_credits() ? 0 : miss_queue_.empty() ? kNever : miss_queue_.front().ready);
}

void L1Cache::run(Cycle now) {
  port_.take_credits(now);
  for (;;) {
    const Cycle departure = next_departure(), arrival = next_fill();
    if (std::min(departure, arrival) > now) return find_due();
    if (departure <= arrival) {  // departures go first: the entry that one frees can take a write-back
      send_front(departure);
    } else if (!fill(arrival)) {
      fill_blocked_ = true;
    }
  }
}

void L1Cache::send_front(Cycle now) {
  Outgoing& out = miss_queue_.front();
  out.packet.stamps.set(Stage::L1Queue, now);
  stats_.request_wait += now - out.ready;
  port_.send(now, out.packet);
  stats_.request_bytes += bytes_of(out.packet);
  ++packets_sent_;
  miss_queue_.pop();
  if (fill_blocked_) fill_blocked_ = false, fill_not_before_ = now;
}

// Takes the oldest reply. Returns false when its line has a dirty victim and the miss queue is full.
bool L1Cache::fill(Cycle now) {
  const Reply reply = port_.front();
  const bool is_kept = !reply.is_atomic && !passing_[mshr_.find(reply.line)];
  if (is_kept && !install(now, reply)) return false;
  ++stats_.fills;
  stats_.reply_bytes += bytes_of(reply);
  stats_.reply_wait += now - port_.arrival();
  sectors_received_ += num_sectors(reply.sectors);
  port_.take(now);
  fill_not_before_ = now + 1;
  if (is_kept) filled_cycle_ = now, filled_bank_ = bank_of(reply.line);
  if (reply.is_atomic) {
    answer(reply.client, false, {now, reply.order, reply.token});
    latencies_.add(Traffic::ShaderAtomic, uint32_t(now) - reply.stamps.accepted);
  } else {
    answer_waiters(now, reply);
  }
  return true;
}

// Returns who waits for a line first, which is looked up only when somebody wants to know.
inline Requester L1Cache::first_requester(Address line) const {
  const Waiter* const first = line_replaced_.has_listeners() ? mshr_.first_waiter(mshr_.find(line)) : nullptr;
  return first ? Requester{first->client, first->token} : Requester{};
}

bool L1Cache::install(Cycle now, const Reply& reply) {
  const uint32_t slot = tags_.find(reply.line);
  if (slot == kNone) {
    if (!tags_.has_victim(reply.line)) {  // all lines are held for others: the data are not kept
      prefetched_.lost(mshr_.find(reply.line), reply.sectors);
      return true;
    }
    if (tags_.victim(reply.line).dirty && queue_full()) return false;
  }
  TagArray::Line& line =
      slot == kNone ? replace(now, reply.line, first_requester(reply.line)) : tags_.line(slot);
  line.valid |= reply.sectors;
  prefetched_.arrived(mshr_.find(reply.line), tags_.slot_of(line), reply.sectors);
  line.held = allocate_on_miss_ && (mshr_.pending(mshr_.find(reply.line)) & ~reply.sectors);
  return true;
}

void L1Cache::answer_waiters(Cycle now, const Reply& reply) {
  mshr_.arrive(mshr_.find(reply.line), reply.sectors, [&](Waiter& waiter) {
    waiter.missing &= uint8_t(~reply.sectors);
    if (waiter.missing) return false;
    answer(waiter.client, false, {now, waiter.order, waiter.token});
    count_miss(waiter, now, reply.stamps);
    return true;
  });
}

void L1Cache::count_miss(const Waiter& waiter, Cycle now, const Stamps& stamps) {
  const Cycle latency = now - waiter.accepted;
  const bool from_dram = stamps.end[size_t(Stage::DramService)] != stamps.end[size_t(Stage::L2Service)];
  stats_.miss_latency.add(latency);
  (from_dram ? stats_.dram_latency : stats_.l2_latency).add(latency);
  ++stats_.timed_misses;
  stats_.miss_cycles += latency;
  add_stages(stats_.miss_stages, waiter.accepted, now, stamps);
  latencies_.add(waiter.traffic, latency);
}

Cycle L1Cache::next_event(Cycle now) const {
  Cycle next = std::min({next_departure(), next_fill(), port_.next_credit()});
  for (size_t client = 0; client < answers_.size(); ++client)
    next = std::min(next, answer_at(Client(client)));
  return next == kNever ? kNever : std::max(next, now);
}

std::string L1Cache::describe() const {
  std::string out;
  if (reads_accepted_ != tokens_returned_)
    out += fmt::format("  L1: {} reads without an answer, {} lines on the way, {} of {} sectors have come\n",
                       reads_accepted_ - tokens_returned_, mshr_.in_use(), sectors_received_,
                       sectors_requested_);
  if (!miss_queue_.empty()) {
    const Packet& first = miss_queue_.front().packet;
    out += fmt::format("  L1: {} packets wait to leave, the first {} line {:#x} for partition {}\n",
                       miss_queue_.size(), first.write ? "writes" : "reads", first.line,
                       map_.partition_of(first.slice));
  }
  return out;
}

bool L1Cache::drained() const {
  return miss_queue_.empty() && mshr_.in_use() == 0 && tokens_returned_ == reads_accepted_ &&
         sectors_requested_ == sectors_received_;
}

}  // namespace glint::mem
