// Declares the messages that cross the network between L1 caches and L2 slices, and their sizes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "base/types.h"
#include "memsys/l1_port.h"
#include "memsys/request.h"
#include "memsys/stages.h"

namespace glint::mem {

// Goes from an L1 to a slice of the L2, and wants or writes sectors of a line.
struct Packet {
  Address line = 0;
  uint16_t core = 0;   // number of the source
  uint16_t slice = 0;  // number of the destination
  uint8_t sectors = 0;
  bool write = false;
  Traffic traffic = Traffic::ShaderGlobal;
  WordMask words = kAllWords;  // words of the line that a write covers
  AtomicLanes atomic{};
  Token token = 0;  // returns in the reply of an atomic, as its client and its order of acceptance do
  Client client = Client::Lsu;
  uint64_t order = 0;
  Stamps stamps{};
};

// Allows the sender of a message to send another one (network_port.h). A credit travels beside the messages.
struct Credit {
  uint16_t allowance = 0;  // number of the sender's count that grows
};

// Brings sectors of a line from a slice of the L2 to an L1. A packet may be answered by several replies,
// sector by sector.
struct Reply {
  Address line = 0;
  uint16_t slice = 0;  // number of the source
  uint16_t core = 0;   // number of the destination
  uint8_t sectors = 0;
  bool is_atomic = false;  // whether it has old values for one access, which no cache keeps
  Token token = 0;
  Client client = Client::Lsu;
  uint64_t order = 0;
  Stamps stamps{};
};

// Address and control travel beside the data. With one 32-byte sector they make GPGPU-Sim's 40-byte flit.
inline constexpr uint32_t kHeaderBytes = 8;

constexpr bool is_atomic(const Packet& p) {
  return p.traffic == Traffic::ShaderAtomic;
}
// Returns the number of turns of an atomic at its sectors.
constexpr uint32_t num_turns(const Packet& p) {
  return std::max<uint32_t>(p.atomic.turns, num_sectors(p.sectors));
}
// Writes and atomics carry data. Model: an atomic carries a sector's worth of data for each sector and turn,
// however many lanes the turn serves.
constexpr uint32_t bytes_of(const Packet& p) {
  return kHeaderBytes + (is_atomic(p) ? num_turns(p) : p.write ? num_sectors(p.sectors) : 0) * kSectorBytes;
}
constexpr uint32_t bytes_of(const Reply& r) {
  return kHeaderBytes + num_sectors(r.sectors) * kSectorBytes;
}

constexpr uint16_t source_of(const Packet& p) {
  return p.core;
}
constexpr uint16_t source_of(const Reply& r) {
  return r.slice;
}
constexpr uint16_t destination_of(const Packet& p) {
  return p.slice;
}
constexpr uint16_t destination_of(const Reply& r) {
  return r.core;
}

}  // namespace glint::mem
