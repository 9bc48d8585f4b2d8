// The register state of one warp, as op handlers see it: rows of 32 lanes, structure of arrays.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "base/types.h"
#include "isa/inst.h"

namespace glint::isa {

using Row = uint32_t[kLanes];  // one 32-bit register of all lanes, 64-byte aligned

// What a memory, texture or surface op asks of the world; filled by its handler for the lanes of `exec`.
// Data moves between memory and the op's operand slots when the machine applies the access.
struct Access {
  alignas(64) std::array<Address, kLanes> address;  // bytes; local space: offset in the lane's own stack;
                                                    // image ops: the handle
};

struct Warp {
  std::array<uint32_t*, 3> bank{};  // registers, constants, specials: bank[slot >> kBankShift]
  std::array<LaneMask, kNumPredicates> predicate{};
  LaneMask exec = 0;  // lanes that execute the present instruction: active and guard
  Access access;

  const uint32_t* read(Slot slot) const {
    return bank[slot >> kBankShift] + (slot & kSlotIndexMask) * kLanes;
  }
  uint32_t* write(Slot slot) { return bank[0] + slot * kLanes; }
};

}  // namespace glint::isa
