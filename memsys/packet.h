// What crosses the network between L1 caches and memory partitions, and the time a port needs for it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/types.h"
#include "memsys/l1_port.h"
#include "memsys/request.h"
#include "memsys/stages.h"

namespace glint::mem {

// From an L1 to a partition: wants, or writes, sectors of a line.
struct Packet {
  Address line = 0;
  uint16_t core = 0;
  uint8_t sectors = 0;
  bool write = false;
  Traffic traffic = Traffic::ShaderGlobal;
  WordMask words = kAllWords;  // of a write
  AtomicLanes atomic{};
  Token token = 0;  // of an atomic, for its reply; its client and order of acceptance too
  Client client = Client::Lsu;
  uint64_t order = 0;
  Stamps stamps{};
};

// A slice has served a packet: its core may send another. Travels beside the replies.
struct Credit {
  uint16_t slice = 0;
};

// From a partition to an L1: sectors of a line. A packet may be answered by several replies, sector by
// sector.
struct Reply {
  Address line = 0;
  uint8_t sectors = 0;
  bool is_atomic = false;  // the old values for one access: nothing that a cache keeps
  Token token = 0;
  Client client = Client::Lsu;
  uint64_t order = 0;
  Stamps stamps{};
};

// Address and control beside the data: with one 32-byte sector this makes GPGPU-Sim's 40-byte flit.
inline constexpr uint32_t kHeaderBytes = 8;

constexpr uint32_t num_sectors(uint8_t mask) {
  return uint32_t(std::popcount(mask));
}
constexpr bool is_atomic(const Packet& p) {
  return p.traffic == Traffic::ShaderAtomic;
}
// Turns of an atomic at its sectors.
constexpr uint32_t num_turns(const Packet& p) {
  return std::max<uint32_t>(p.atomic.turns, num_sectors(p.sectors));
}
// Writes and atomics carry data. Model: a sector's worth a sector and turn, as many lanes as it may serve.
constexpr uint32_t bytes_of(const Packet& p) {
  return kHeaderBytes + (is_atomic(p) ? num_turns(p) : p.write ? num_sectors(p.sectors) : 0) * kSectorBytes;
}
constexpr uint32_t bytes_of(const Reply& r) {
  return kHeaderBytes + num_sectors(r.sectors) * kSectorBytes;
}

// One side of a crossbar port. A packet occupies it for a whole number of cycles.
// Model: the switch inside never blocks; ports and, towards the slices, credits limit.
class Port {
 public:
  explicit Port(uint32_t bytes_per_cycle) : bytes_per_cycle_(bytes_per_cycle) {}

  Cycle cycles(uint32_t bytes) const { return (bytes + bytes_per_cycle_ - 1) / bytes_per_cycle_; }
  Cycle free_at() const { return free_at_; }

  // Sending: the packet starts at max(ready, free) and its tail has left at the cycle returned.
  Cycle leave(Cycle ready, uint32_t bytes) { return free_at_ = std::max(ready, free_at_) + cycles(bytes); }

  // Receiving a packet whose tail arrives at `tail` after `sent_cycles` on the sending port: when the port
  // has all of it. Unloaded and equally wide, receiving overlaps sending and costs nothing more.
  Cycle received_at(Cycle tail, Cycle sent_cycles, uint32_t bytes) const {
    const Cycle head = tail - sent_cycles;
    return std::max(tail, std::max(head, free_at_) + cycles(bytes));
  }
  void occupy_until(Cycle cycle) { free_at_ = cycle; }

 private:
  uint32_t bytes_per_cycle_;
  Cycle free_at_ = 0;
};

}  // namespace glint::mem
