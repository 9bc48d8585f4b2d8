// Holds the register state of one warp as op handlers see it: rows of 32 lanes, as a structure of arrays.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "base/types.h"
#include "isa/inst.h"

namespace glint::isa {

using Row = uint32_t[kLanes];  // one 32-bit register of all lanes, 64-byte aligned

// Holds the addresses of a memory, texture or surface op, which its handler fills for the lanes of `exec`.
// Data moves between memory and the op's operand slots when the machine applies the access.
struct Access {
  // Bytes; for local space the offset in the lane's own stack, and for image ops the handle.
  alignas(64) std::array<Address, kLanes> address;
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
