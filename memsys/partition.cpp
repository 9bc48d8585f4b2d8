// The events of a partition: packets in, tags, the way to DRAM and back, replies out.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/partition.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace glint::mem {
namespace {

uint32_t num_ways(uint64_t size, uint32_t ways, uint32_t line) { return ways ? ways : uint32_t(size / line); }

}  // namespace

Partition::Partition(const Params& params, uint32_t index, const PartitionMap& map, double core_mhz,
                     FanIn<Packet>* requests, std::vector<FanIn<Reply>*> replies, stats::Group* parent)
    : group_(parent, fmt::format("partition[{}]", index)),
      params_(params.l2),
      line_bytes_(params.line),
      atom_sectors_(std::max(params.dram.atom_bytes(), kSectorBytes) / kSectorBytes),
      index_(index),
      dram_latency_(params.dram.latency),
      reply_latency_(params.noc.reply_latency),
      map_(map),
      requests_(requests),
      replies_(std::move(replies)),
      stats_(&group_),
      dram_(params.dram.model.make({params.dram, params.interleave, core_mhz, &group_})),
      tags_(uint32_t(params_.slice_size / line_bytes_) / num_ways(params_.slice_size, params_.ways, line_bytes_),
            num_ways(params_.slice_size, params_.ways, line_bytes_), line_bytes_),
      mshr_(params_.mshr_entries, params_.mshr_merges),
      request_port_(params.noc.partition_request_bytes),
      reply_port_(params.noc.partition_reply_bytes),
      core_request_port_(params.noc.core_request_bytes),
      to_dram_(params_.dram_queue) {}

void Partition::advance(Cycle from, Cycle until) {
  account(from);
  for (;;) {
    const Cycle now = std::max(next_work(), from);
    if (now >= until) break;
    account(now);
    step(now);
    from = now + 1;
  }
  account(until);
}

// Stages from back to front: what leaves makes room for what enters in the same cycle.
void Partition::step(Cycle now) {
  sampler_.reach(now);
  dram_->advance(now);
  receive_from_dram(now);
  feed_dram(now);
  while (!hit_replies_.empty() && hit_replies_.front().ready <= now) {
    send_reply(now, hit_replies_.front().core, hit_replies_.front().reply);
    hit_replies_.pop();
  }
  serve(now);
}

Cycle Partition::next_work() const {
  Cycle next = dram_->next_command();
  if (!dram_->returns().empty()) next = std::min(next, dram_->returns().front().ready);
  if (!hit_replies_.empty()) next = std::min(next, hit_replies_.front().ready);
  // A full scheduler or a blocked head moves only with one of the events above.
  if (!to_dram_.empty() && !dram_->full()) next = std::min(next, to_dram_.front().ready);
  if (blocked_ == PartitionCycle::Count) next = std::min(next, head_received());
  return next;
}

Cycle Partition::next_event(Cycle from) const {
  const Cycle next = next_work();
  return next == kNever ? kNever : std::max(next, from);
}

Cycle Partition::head_received() const {
  if (requests_->arrival() == kNever) return kNever;
  const uint32_t bytes = bytes_of(requests_->front());
  return std::max(request_port_.received_at(requests_->arrival(), core_request_port_.cycles(bytes), bytes), busy_until_);
}

void Partition::feed_dram(Cycle now) {
  while (!to_dram_.empty() && to_dram_.front().ready <= now && !dram_->full()) {
    const ToDram& out = to_dram_.front();
    dram_->add(now, out.line, out.sectors, map_.local(out.line + uint64_t(std::countr_zero(out.sectors)) * kSectorBytes), out.write);
    to_dram_.pop();
  }
}

void Partition::receive_from_dram(Cycle now) {
  Ring<DramReturn>& returns = dram_->returns();
  for (; !returns.empty() && returns.front().ready <= now; returns.pop())
    fill(now, returns.front());
}

// The answer to a packet, or to some of its sectors.
Reply Partition::reply_to(const Packet& packet, uint8_t sectors) const {
  if (!is_atomic(packet)) return {packet.line, sectors, false, 0, Client::Lsu, 0, packet.stamps};
  return {packet.line, packet.sectors, true, packet.token, packet.client, packet.order, packet.stamps};
}

void Partition::fill(Cycle now, const DramReturn& data) {
  const Address line = data.line;
  const uint8_t sectors = data.sectors;
  const uint32_t slot = tags_.find(line);
  if (slot == kNone) evict(now, tags_.victim(line));
  TagArray::Line& filled = slot == kNone ? tags_.insert(line) : tags_.line(slot);
  filled.valid |= sectors;
  mshr_.arrive(mshr_.find(line), sectors, [&](Waiter& waiter) {
    Packet& packet = waiter.packet;
    packet.stamps.set(Stage::DramQueue, data.command);
    packet.stamps.set(Stage::DramService, now);
    const uint8_t served = uint8_t(waiter.missing & sectors);
    waiter.missing &= uint8_t(~sectors);
    if (!is_atomic(packet)) {
      if (served) send_reply(now, packet.core, reply_to(packet, served));
    } else if (waiter.missing == 0) {
      filled.dirty |= packet.sectors & filled.valid;
      if (!packet.write) send_reply(now, packet.core, reply_to(packet, packet.sectors));
    }
    return waiter.missing == 0;
  });
}

void Partition::serve(Cycle now) {
  blocked_ = PartitionCycle::Count;
  if (head_received() > now) return;
  Packet packet = requests_->front();
  packet.stamps.set(Stage::Request, requests_->arrival());
  packet.stamps.set(Stage::L2Queue, now);
  packet.stamps.set(Stage::L2Service, now + params_.latency);
  packet.stamps.set(Stage::DramWay, now + params_.latency + dram_latency_);
  if (!(packet.write && !is_atomic(packet) ? write(now, packet) : read(now, packet))) return;
  const uint32_t bytes = bytes_of(packet);
  request_port_.occupy_until(request_port_.received_at(requests_->arrival(), core_request_port_.cycles(bytes), bytes));
  stats_.request_bytes += bytes;
  stats_.request_wait += now - requests_->arrival();
  ++packets_received_;
  busy_until_ = now + service_cycles(packet);
  requests_->pop();
}

Cycle Partition::service_cycles(const Packet& packet) const {
  const Cycle sectors = num_sectors(packet.sectors);
  if (is_atomic(packet)) return sectors * params_.atomic_interval;
  return (sectors + params_.sectors_per_cycle - 1) / params_.sectors_per_cycle;
}

// Reads, and atomics, which need what they change.
bool Partition::read(Cycle now, const Packet& packet) {
  const uint32_t slot = tags_.find(packet.line);
  const uint8_t missing = slot == kNone ? packet.sectors : uint8_t(packet.sectors & ~tags_.line(slot).valid);
  uint8_t fetched = 0;
  if (missing) {
    uint32_t entry = mshr_.find(packet.line);
    if (entry == kNone && mshr_.full()) return blocked_ = PartitionCycle::MshrFull, false;
    if (entry != kNone && mshr_.merge_limit(entry)) return blocked_ = PartitionCycle::MergeLimit, false;
    if (const uint8_t absent = entry == kNone ? missing : uint8_t(missing & ~mshr_.pending(entry))) {
      fetched = entry == kNone ? whole_atoms(absent) : uint8_t(whole_atoms(absent) & ~mshr_.pending(entry));
      if (!dram_room(num_sectors(fetched))) return blocked_ = PartitionCycle::QueueFull, false;
    }
    if (entry == kNone) entry = mshr_.allocate(packet.line);
    mshr_.expect(entry, fetched);
    mshr_.add(entry, {packet, missing});
    if (fetched) queue_for_dram(now + params_.latency + dram_latency_, packet.line, fetched, false);
  }
  if (slot != kNone) tags_.touch(slot);
  answer_present(now, packet, missing);
  if (!packet.write) sectors_requested_ += num_sectors(packet.sectors);
  stats_.count_read(packet.traffic, missing, fetched, packet.line, seen_);
  return true;
}

// Replies for what is here. An atomic waits for all of its sectors, and is done in one piece.
// Model: the atomics of one line follow each other at the slice's pace, whether they wait for DRAM or not.
void Partition::answer_present(Cycle now, const Packet& packet, uint8_t missing) {
  const Cycle ready = now + service_cycles(packet) - 1 + params_.latency;
  if (!is_atomic(packet)) {
    if (const uint8_t present = uint8_t(packet.sectors & ~missing)) {
      hit_replies_.push({ready, reply_to(packet, present), packet.core});
      hit_replies_.back().reply.stamps.set_rest(Stage::L2Service, ready);
    }
    return;
  }
  if (missing) return;
  tags_.line(tags_.find(packet.line)).dirty |= packet.sectors;
  if (!packet.write) hit_replies_.push({ready, reply_to(packet, packet.sectors), packet.core});
}

bool Partition::write(Cycle now, const Packet& packet) {
  const uint32_t slot = tags_.find(packet.line);
  if (slot == kNone) {
    const TagArray::Line& victim = tags_.victim(packet.line);
    if (victim.dirty && !dram_room(num_sectors(victim.dirty))) return blocked_ = PartitionCycle::QueueFull, false;
    evict(now, victim);
    seen_.insert_if_new(packet.line);
  } else {
    tags_.touch(slot);
    stats_.write_hits.add(packet.traffic);
  }
  TagArray::Line& line = slot == kNone ? tags_.insert(packet.line) : tags_.line(slot);
  line.valid |= packet.sectors;
  line.dirty |= packet.sectors;
  stats_.writes.add(packet.traffic);
  return true;
}

// One DRAM request an atom that holds any of `sectors`.
void Partition::queue_for_dram(Cycle ready, Address line, uint8_t sectors, bool write) {
  const uint32_t atom = (1u << atom_sectors_) - 1;
  for (uint32_t first = 0; first < line_bytes_ / kSectorBytes; first += atom_sectors_)
    if (const uint8_t mask = uint8_t(sectors & (atom << first))) to_dram_.push({ready, line, mask, write});
}

uint8_t Partition::whole_atoms(uint8_t sectors) const {
  const uint32_t atom = (1u << atom_sectors_) - 1;
  uint8_t out = 0;
  for (uint32_t first = 0; first < line_bytes_ / kSectorBytes; first += atom_sectors_)
    if (sectors & (atom << first)) out |= uint8_t(atom << first);
  return out;
}

void Partition::evict(Cycle now, const TagArray::Line& victim) {
  if (!victim.valid) return;
  ++stats_.evictions;
  if (!victim.dirty) return;
  ++stats_.write_backs;
  queue_for_dram(now + dram_latency_, victim.address, victim.dirty, true);
}

void Partition::send_reply(Cycle now, uint16_t core, const Reply& reply) {
  stats_.reply_wait += std::max(now, reply_port_.free_at()) - now;
  const uint32_t bytes = bytes_of(reply);
  const Cycle tail = reply_port_.leave(now, bytes);
  replies_[core]->send(index_, tail + reply_latency_, reply);
  stats_.reply_bytes += bytes;
  sectors_replied_ += num_sectors(reply.sectors);
  ++replies_sent_;
}

// Why nothing is served from accounted_ on, until the next event.
PartitionCycle Partition::reason() const {
  if (blocked_ != PartitionCycle::Count) return blocked_;
  if (dram_->in_flight() > 0 || !dram_->returns().empty()) return PartitionCycle::DramWait;
  if (!hit_replies_.empty() || !to_dram_.empty()) return PartitionCycle::Pipeline;
  return PartitionCycle::Idle;
}

// Attributes the cycles [accounted_, until), after the last event and before the next.
void Partition::account(Cycle until) {
  if (until <= accounted_) return;
  const Cycle serving = std::clamp(busy_until_, accounted_, until) - accounted_;
  stats_.cycles.add(PartitionCycle::Service, serving);
  stats_.cycles.add(reason(), until - accounted_ - serving);
  accounted_ = until;
}

void Partition::finish(Cycle end) {
  sampler_.finish(end);
  account(end);
  dram_->finish(end);
}

bool Partition::finished() const {
  return requests_->waiting() == 0 && hit_replies_.empty() && to_dram_.empty() && mshr_.in_use() == 0 && dram_->finished();
}

bool Partition::drained() const { return finished() && sectors_requested_ == sectors_replied_; }

std::string Partition::describe_stall() const {
  return fmt::format("partition {}: {} packets waiting, {} lines on the way, {} for DRAM, {} in DRAM, head: {}\n", index_,
                     requests_->waiting(), mshr_.in_use(), to_dram_.size(), dram_->in_flight(), name_of(reason()));
}

}  // namespace glint::mem
