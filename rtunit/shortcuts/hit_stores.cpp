// Sends a store for every single hit, and keeps the warp until its last store is acknowledged.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/shortcuts/hit_stores.h"

#include <algorithm>
#include <bit>

namespace glint::rt {

HitStores::HitStores(uint32_t latency, mem::L1Port& l1, WarpBuffer& buffer, RtStats& stats, Address records,
                     bool has_tables)
    : latency_(latency),
      l1_(l1),
      buffer_(buffer),
      stats_(stats),
      records_(records),
      has_tables_(has_tables),
      stores_(buffer.size()) {
}

// A triangle takes one store, a candidate of a table two.
void HitStores::visited(const Visit& visit) {
  const uint32_t added = has_tables_ && visit.ray.table ? visit.ray.table->take_unwritten() : 0;
  stores_[visit.slot].in_test[size_t(visit.lane)] = uint8_t(visit.hits + 2 * uint32_t(std::popcount(added)));
}

void HitStores::test_ended(uint32_t slot, int lane) {
  uint8_t& in_test = stores_[slot].in_test[size_t(lane)];
  if (in_test == 0) return;
  stores_[slot].unsent += in_test;
  num_unsent_ += in_test;
  buffer_.add_writes(slot, in_test);
  in_test = 0;
}

// Model: it makes no difference which lane's hit is sent. The warp that has been in the unit longest sends
// first.
bool HitStores::send(Cycle now) {
  uint32_t oldest = ~0u;
  for (uint32_t i = 0; i < stores_.size(); ++i)
    if (stores_[i].unsent && (oldest == ~0u || buffer_[i].age < buffer_[oldest].age)) oldest = i;
  mem::Request request;
  request.line = records_ + Address(next_record_) * kRecordBytes;
  request.sectors = 1;
  request.write = true;
  request.traffic = mem::Traffic::RtNode;
  if (!l1_.access(now, mem::Client::RtUnit, request)) return false;
  ++stats_.hit_writes;
  next_record_ = (next_record_ + 1) % kRecords;
  --stores_[oldest].unsent;
  --num_unsent_;
  stores_[oldest].last_sent = now;
  buffer_.write_sent(oldest, now);
  return true;
}

bool HitStores::holds(uint32_t slot, Cycle now) {
  const bool is_waiting = stores_[slot].last_sent != 0 && stores_[slot].last_sent + latency_ > now;
  stores_[slot].is_waiting = is_waiting;
  num_waiting_ += is_waiting;
  if (!is_waiting) stores_[slot].last_sent = 0;
  return is_waiting;
}

void HitStores::acknowledge(Cycle now) {
  if (num_waiting_ == 0) return;
  for (uint32_t i = 0; i < stores_.size(); ++i) {
    Stores& stores = stores_[i];
    if (!stores.is_waiting || stores.last_sent + latency_ > now) continue;
    stores.is_waiting = false;
    stores.last_sent = 0;
    --num_waiting_;
    buffer_.leave(i, now);
  }
}

Cycle HitStores::next_event(Cycle now) const {
  if (has_request(now)) return now + 1;
  Cycle next = kNever;
  for (const Stores& stores : stores_)
    if (stores.is_waiting) next = std::min(next, stores.last_sent + latency_);
  return next;
}

}  // namespace glint::rt
