// Interface: chooses which line of a set makes way for a new line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "base/types.h"
#include "memsys/request.h"

namespace glint::mem {

// Describes a line of a cache in 8 bytes, because a look-up reads those of a whole set. Each mask has one bit
// for each sector of 32 bytes.
struct CacheLine {
  uint32_t key = kNoLine;  // line_key() of the line's address, or kNoLine when the slot holds no line
  uint8_t valid = 0;       // sectors that are present
  uint8_t dirty = 0;       // sectors that are newer than the level below, also those written only in part
  bool held = false;       // whether data of the line are on the way, so that it is never a victim
  bool used() const { return valid || dirty || held; }
  Address address() const { return Address{key} * kSectorBytes; }
};

// A slot holds one line: slot = set * ways + way.
//
// Contract (tests/contract/memsys/replacement_test.cpp):
//  - victim() returns a slot of the set whose line is not held, or kNone when every line of the set is held.
//  - victim() changes nothing: it returns the same slot again until a call reports an event.
//  - The answer depends on the lines of the set and on the events of the cache, in their order. Sets may
//    share state, as they do in set duelling: one cell of the engine owns a cache, so that neither threads
//    nor windows change the order of its events. A policy whose sets share nothing depends on the events of
//    the set alone.
//  - The policy allocates nothing after its construction.
class Replacement {
 public:
  static constexpr PolicyKind kKind{"*.replacement", "memsys/replacement"};
  struct Context {
    uint32_t sets = 1, ways = 1;
  };
  static constexpr uint32_t kNone = ~0u;

  virtual ~Replacement() = default;
  // Returns the slot whose line makes way. `lines` holds all lines of the cache, by slot.
  virtual uint32_t victim(uint32_t set, std::span<const CacheLine> lines) const = 0;
  virtual void filled(uint32_t slot) = 0;   // reports that the slot got a new line
  virtual void touched(uint32_t slot) = 0;  // reports that an access found its line in the slot
  virtual void emptied(uint32_t) {}         // reports that the line in the slot lost its last sector
  // Brings what the policy knows of the set near to the host's core.
  virtual void prefetch(uint32_t /*set*/) const {}
};

// Returns the first slot from `first` to `first + ways - 1` that holds no line, or kNone.
inline uint32_t first_unused(std::span<const CacheLine> lines, uint32_t first, uint32_t ways) {
  for (uint32_t slot = first; slot < first + ways; ++slot)
    if (!lines[slot].used()) return slot;
  return Replacement::kNone;
}

}  // namespace glint::mem
