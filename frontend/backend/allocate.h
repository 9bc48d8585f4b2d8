// Register allocation: graph colouring with coalescing; what does not fit is spilled to the frame.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "frontend/backend/slots.h"

namespace glint::frontend {

// Physical place of each virtual register: register number (of the low half for B64) or predicate number.
struct Allocation {
  std::vector<uint16_t> slot;
};

inline constexpr uint32_t kFewestRegisters = 8;  // below, one store of a vector and its address do not fit

// Gives every virtual register a place below `max_registers`, %r0 left out, 64-bit values at even places.
// Inserts spill code and grows program.local_bytes where needed. UserError when an instruction needs more at
// once.
Allocation allocate(VirtualProgram& program, uint32_t max_registers, const Ops& ops);

}  // namespace glint::frontend
