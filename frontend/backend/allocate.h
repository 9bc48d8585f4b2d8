// Allocates registers by graph colouring with coalescing. Values that do not fit are spilled to the frame.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "frontend/backend/slots.h"

namespace glint::frontend {

// Gives the physical place of each virtual register: a register number (for B64, the number of the low half)
// or a predicate number.
struct Allocation {
  std::vector<uint16_t> slot;
};

// With fewer registers, a store of a vector and its address would not fit.
inline constexpr uint32_t kFewestRegisters = 8;

// Gives every virtual register a place below `max_registers`, except %r0. 64-bit values get even places. It
// inserts spill code and grows program.local_bytes where needed. Throws UserError when one instruction needs
// more registers at once.
Allocation allocate(VirtualProgram& program, uint32_t max_registers, const Ops& ops);

}  // namespace glint::frontend
