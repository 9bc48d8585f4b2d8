// Handles the events of an L2 slice: packets that come, requests to DRAM and their data, replies that leave.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/cache/l2_slice.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <utility>

namespace glint::mem {
namespace {

// Returns `cycles` in parts of a cycle, rounded to the nearest.
Cycle parts_of(double cycles, Cycle parts) {
  return Cycle(cycles * double(parts) + 0.5);
}

}  // namespace

L2Slice::L2Slice(const Params& params, uint32_t index, const PartitionMap& map, SlicePort port,
                 stats::Group* parent, const std::string& name)
    : params_(params.l2),
      read_parts_(parts_of(params.l2.read_interval, kParts)),
      read_visit_parts_(parts_of(params.l2.read_visit, kParts)),
      atomic_visit_parts_(parts_of(params.l2.atomic_visit, kParts)),
      visit_parts_(parts_of(params.l2.write_visit, kParts)),
      partial_parts_(parts_of(params.l2.partial_interval, kParts)),
      turn_parts_(parts_of(params.l2.atomic_interval, kParts)),
      whole_parts_(parts_of(params.l2.atomic_whole_interval, kParts)),
      float_parts_(parts_of(params.l2.atomic_float_interval, kParts)),
      lane_parts_(parts_of(params.l2.atomic_lane_interval, kParts)),
      answer_parts_(parts_of(params.l2.atomic_answer_interval, kParts)),
      line_bytes_(params.line),
      atom_sectors_(std::max(params.dram.atom_bytes(), kSectorBytes) / kSectorBytes),
      index_(index),
      dram_latency_(params.dram.latency + (index / params.l2.slices % 2) * params.dram.far_latency),
      map_(map),
      port_(std::move(port)),
      stats_(parent, name),
      tags_(cache_shape(params_.slice_size, params_.ways, line_bytes_), params_.replacement),
      words_(params_.write_masks ? params_.slice_size / line_bytes_ : 0),
      mshr_(params_.mshr_entries, params_.mshr_merges),
      seen_(line_bytes_),
      to_dram_(params_.dram_queue) {
}

void L2Slice::prefetch() const {
  constexpr size_t kPackets = 32;  // Choice: a window of 48 cycles serves hardly more.
  port_.each_coming(kPackets, [&](const Packet& packet) { tags_.prefetch(packet.line); });
}

void L2Slice::send_ready_replies(Cycle now) {
  while (!hit_replies_.empty() && hit_replies_.front().ready <= now) {
    send_reply(now, hit_replies_.front().reply);
    hit_replies_.pop();
  }
}

Cycle L2Slice::next_work() const {
  Cycle next = hit_replies_.empty() ? kNever : hit_replies_.front().ready;
  // A blocked packet moves only when data have come from DRAM or a request has left for it.
  if (blocked_ == SliceCycle::Count) next = std::min(next, head_received());
  return next;
}

Cycle L2Slice::head_received() const {
  return port_.arrival() == kNever ? kNever : std::max(port_.received(), busy_until_);
}

// Returns the answer to a packet, or to some of its sectors.
Reply L2Slice::reply_to(const Packet& packet, uint8_t sectors) const {
  Reply reply{.line = packet.line,
              .slice = packet.slice,
              .core = packet.core,
              .sectors = sectors,
              .stamps = packet.stamps};
  if (!is_atomic(packet)) return reply;
  reply.sectors = packet.sectors;
  reply.is_atomic = true;
  reply.token = packet.token;
  reply.client = packet.client;
  reply.order = packet.order;
  return reply;
}

void L2Slice::fill(Cycle now, const DramReturn& data) {
  const Address line = data.line;
  const uint8_t sectors = data.sectors;
  const uint32_t slot = tags_.find(line);
  if (slot == kNone) evict(now, tags_.victim(line));
  TagArray::Line& filled = slot == kNone ? tags_.insert(line) : tags_.line(slot);
  if (!words_.empty())
    stats_.completed_sectors += num_sectors(sectors & filled.dirty & uint8_t(~filled.valid));
  filled.valid |= sectors;
  if (params_.fill_takes_service) {
    busy_until_ = std::max(busy_until_, now) + sector_cycles(sectors);
    busy_parts_ = busy_until_ * kParts;
  }
  mshr_.arrive(mshr_.find(line), sectors, [&](Waiter& waiter) {
    Packet& packet = waiter.packet;
    packet.stamps.set(Stage::DramQueue, data.command);
    packet.stamps.set(Stage::DramService, now);
    const uint8_t served = uint8_t(waiter.missing & sectors);
    waiter.missing &= uint8_t(~sectors);
    if (!is_atomic(packet)) {
      if (served) send_reply(now, reply_to(packet, served));
    } else if (waiter.missing == 0) {
      filled.dirty |= packet.sectors & filled.valid;
      if (!packet.write) send_reply(now, reply_to(packet, packet.sectors));
    }
    return waiter.missing == 0;
  });
}

uint32_t L2Slice::warm(Address line, uint8_t sectors, Touch touch, Displaced displaced) {
  const uint32_t slot = tags_.find(line);
  uint32_t lost = 0;
  if (slot != kNone) {
    tags_.touch(slot);
  } else if (const TagArray::Line& victim = tags_.victim(line); victim.dirty) {
    if (displaced == Displaced::WrittenLater)
      displaced_.push({victim.address(), victim.dirty});
    else
      lost = num_sectors(victim.dirty);
  }
  TagArray::Line& held = slot == kNone ? tags_.insert(line) : tags_.line(slot);
  held.valid |= sectors;
  if (touch == Touch::Write) held.dirty |= sectors;
  seen_.insert_if_new(line);
  return lost;
}

// Touches a line of each other part of the machine, where the packet is for memory of one thread. These lines
// lie above all that is in use. They hold no data, so they are never dirty.
void L2Slice::touch_others(const Packet& packet) {
  const Address apart = kMaxPhysicalBytes / (others_ + 1) / line_bytes_ * line_bytes_;
  for (uint32_t i = 1; i <= others_; ++i)
    warm(packet.line + i * apart, packet.sectors, Touch::Read, Displaced::WrittenLater);
}

uint64_t L2Slice::dirty_sectors() const {
  uint64_t sum = 0;
  for (uint32_t slot = 0; slot < tags_.num_lines(); ++slot) sum += num_sectors(tags_.line(slot).dirty);
  return sum;
}

void L2Slice::serve(Cycle now) {
  blocked_ = SliceCycle::Count;
  if (head_received() > now) return;
  Packet packet = port_.front();
  packet.stamps.set(Stage::Request, port_.arrival());
  packet.stamps.set(Stage::L2Queue, now);
  packet.stamps.set(Stage::L2Service, now + params_.latency);
  packet.stamps.set(Stage::DramWay, now + params_.latency + dram_latency_);
  if (!(packet.write && !is_atomic(packet) ? write(now, packet) : read(now, packet))) return;
  stats_.request_bytes += bytes_of(packet);
  stats_.request_wait += now - port_.arrival();
  ++packets_received_;
  port_.take(now);
  occupy(now, packet);
  if (others_ && is_local(packet.traffic)) touch_others(packet);
  if (is_atomic(packet)) atomic_line_ = packet.line;
  if (packet.write) written_until_ = busy_until_;
}

Cycle L2Slice::service_parts(const Packet& packet) const {
  if (!is_atomic(packet)) return read_parts(packet.sectors);
  const bool is_other_line = packet.line != atomic_line_;
  const Cycle lane = packet.write || !is_other_line ? lane_parts_ : lane_parts_ + answer_parts_;
  const Cycle turns = num_turns(packet);
  const bool is_float = float_parts_ > 0 && packet.atomic.adds_floats;
  const bool is_whole = whole_parts_ > 0 && packet.atomic.lanes == turns * (kSectorBytes / 4);
  return turns * (is_float   ? float_parts_
                  : is_whole ? whole_parts_
                             : turn_parts_) +
         packet.atomic.lanes * lane + (is_other_line ? atomic_visit_parts_ : 0);
}

Cycle L2Slice::read_parts(uint8_t sectors) const {
  return read_parts_ == 0 ? sector_cycles(sectors) * kParts
                          : std::max(read_visit_parts_, num_sectors(sectors) * read_parts_);
}

// Keeps the slice busy with a packet. Packets may take parts of cycles: one that waited for the one
// before begins in the part in which that packet ended.
void L2Slice::occupy(Cycle now, const Packet& packet) {
  const bool is_write = packet.write && !is_atomic(packet);
  const Cycle parts = is_write && visit_parts_ + partial_parts_ ? write_parts(packet) : service_parts(packet);
  busy_parts_ = (busy_until_ == now ? busy_parts_ : now * kParts) + parts;
  busy_until_ = (busy_parts_ + kParts - 1) / kParts;
}

// Returns the time of a write. A sector that is written in part has a time of its own.
Cycle L2Slice::write_parts(const Packet& packet) const {
  const uint8_t covered = covered_sectors(packet, line_bytes_);
  if (visit_parts_ == 0)
    return sector_cycles(covered) * kParts + num_sectors(uint8_t(packet.sectors & ~covered)) * partial_parts_;
  const auto part = uint8_t(partial_parts_ ? packet.sectors & ~covered : 0);
  return visit_parts_ + num_sectors(uint8_t(packet.sectors & ~part)) * kParts +
         num_sectors(part) * partial_parts_;
}

// Serves a read or an atomic. An atomic needs the sectors that it changes, as a read does.
bool L2Slice::read(Cycle now, const Packet& packet) {
  const uint32_t slot = tags_.find(packet.line);
  const uint8_t missing = slot == kNone ? packet.sectors : uint8_t(packet.sectors & ~tags_.line(slot).valid);
  uint8_t fetched = 0;
  if (missing) {
    uint32_t entry = mshr_.find(packet.line);
    if (entry == kNone && mshr_.full()) return blocked_ = SliceCycle::MshrFull, false;
    if (entry != kNone && mshr_.merge_limit(entry)) return blocked_ = SliceCycle::MergeLimit, false;
    if (const uint8_t absent = entry == kNone ? missing : uint8_t(missing & ~mshr_.pending(entry))) {
      fetched = entry == kNone ? whole_atoms(absent) : uint8_t(whole_atoms(absent) & ~mshr_.pending(entry));
      if (!dram_room(num_sectors(fetched))) return blocked_ = SliceCycle::QueueFull, false;
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

// Answers the sectors that are present. An atomic waits for all of its sectors and is done at once.
// Model: the atomics of one line follow each other at the slice's pace, whether they wait for DRAM or not.
void L2Slice::answer_present(Cycle now, const Packet& packet, uint8_t missing) {
  const Cycle ready = now + (service_parts(packet) + kParts - 1) / kParts - 1 + params_.latency;
  if (!is_atomic(packet)) {
    if (const uint8_t present = uint8_t(packet.sectors & ~missing)) {
      hit_replies_.push({ready, reply_to(packet, present)});
      hit_replies_.back().reply.stamps.set_rest(Stage::L2Service, ready);
    }
    return;
  }
  if (missing) return;
  tags_.line(tags_.find(packet.line)).dirty |= packet.sectors;
  if (!packet.write) hit_replies_.push({ready, reply_to(packet, packet.sectors)});
}

bool L2Slice::write(Cycle now, const Packet& packet) {
  const uint32_t slot = tags_.find(packet.line);
  if (slot == kNone) {
    const TagArray::Line& victim = tags_.victim(packet.line);
    const uint8_t leaving = sectors_leaving(victim);
    if (leaving && !dram_room(num_sectors(leaving))) return blocked_ = SliceCycle::QueueFull, false;
    evict(now, victim);
    seen_.insert_if_new(packet.line);
  } else {
    tags_.touch(slot);
    stats_.write_hits.add(packet.traffic);
  }
  TagArray::Line& line = slot == kNone ? tags_.insert(packet.line) : tags_.line(slot);
  line.valid |= words_.empty() || packet.words == kAllWords
                    ? packet.sectors
                    : whole_sectors(packet, tags_.slot_of(line), line.valid);
  line.dirty |= packet.sectors;
  stats_.writes.add(packet.traffic);
  return true;
}

// Returns the sectors of a write that the slice then holds whole: they were valid, or the write covers or
// completes them.
uint8_t L2Slice::whole_sectors(const Packet& packet, uint32_t slot, uint8_t valid) {
  uint8_t out = 0;
  for (uint32_t i = 0; i < line_bytes_ / kSectorBytes; ++i) {
    const auto bit = uint8_t(1u << i);
    if (!(packet.sectors & bit)) continue;
    const WordMask whole = words_of_sector(i, line_bytes_);
    if (!(tags_.line(slot).dirty & bit))
      words_[slot] &= ~whole;  // these bits are of an earlier line in the slot, or of old data
    words_[slot] |= packet.words & whole;
    if ((valid & bit) || (words_[slot] & whole) == whole)
      out |= bit;
    else
      ++stats_.partial_writes;
  }
  return out;
}

// Queues one DRAM request for each atom that holds any of `sectors`.
void L2Slice::queue_for_dram(Cycle ready, Address line, uint8_t sectors, bool write) {
  const uint32_t atom = (1u << atom_sectors_) - 1;
  for (uint32_t first = 0; first < line_bytes_ / kSectorBytes; first += atom_sectors_)
    if (const uint8_t mask = uint8_t(sectors & (atom << first))) {
      to_dram_.push({ready, line, mask, write});
      ++(write ? stats_.dram_writes : stats_.dram_reads);
    }
}

uint8_t L2Slice::whole_atoms(uint8_t sectors) const {
  const uint32_t atom = (1u << atom_sectors_) - 1;
  uint8_t out = 0;
  for (uint32_t first = 0; first < line_bytes_ / kSectorBytes; first += atom_sectors_)
    if (sectors & (atom << first)) out |= uint8_t(atom << first);
  return out;
}

// Returns the sectors that go to DRAM when the victim makes way: its own, or those of a line that warm() has
// displaced.
uint8_t L2Slice::sectors_leaving(const TagArray::Line& victim) const {
  if (victim.dirty) return victim.dirty;
  return displaced_.empty() ? uint8_t{0} : displaced_.front().sectors;
}

void L2Slice::evict(Cycle now, const TagArray::Line& victim) {
  if (victim.used()) ++stats_.evictions;
  const uint8_t leaving = sectors_leaving(victim);
  if (!leaving) return;
  ++stats_.write_backs;
  queue_for_dram(now + dram_latency_, victim.dirty ? victim.address() : displaced_.front().line, leaving,
                 true);
  if (!victim.dirty) displaced_.pop();
}

void L2Slice::send_reply(Cycle now, const Reply& reply) {
  stats_.reply_wait += port_.send(now, reply) - now;
  stats_.reply_bytes += bytes_of(reply);
  sectors_replied_ += num_sectors(reply.sectors);
  ++replies_sent_;
}

// Returns why nothing is served from accounted_ until the next event.
SliceCycle L2Slice::reason(bool dram_works) const {
  if (blocked_ != SliceCycle::Count) return blocked_;
  if (dram_works) return SliceCycle::DramWait;
  if (!hit_replies_.empty() || !to_dram_.empty()) return SliceCycle::Pipeline;
  return SliceCycle::Idle;
}

// Counts the cycles [accounted_, until), which lie after the last event and before the next, by reason.
void L2Slice::account(Cycle until, bool dram_works) {
  if (until <= accounted_) return;
  const Cycle serving = std::clamp(busy_until_, accounted_, until) - accounted_;
  stats_.cycles.add(SliceCycle::Service, serving);
  stats_.cycles.add(reason(dram_works), until - accounted_ - serving);
  accounted_ = until;
}

bool L2Slice::finished() const {
  return port_.waiting() == 0 && hit_replies_.empty() && to_dram_.empty() && mshr_.in_use() == 0;
}

std::string L2Slice::describe(bool dram_works) const {
  return fmt::format("{} packets waiting, {} lines on the way, {} for DRAM, head: {}", port_.waiting(),
                     mshr_.in_use(), to_dram_.size(), name_of(reason(dram_works)));
}

}  // namespace glint::mem
