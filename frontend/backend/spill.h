// Moves values out of registers: to a slot of the frame, to a constant that is named again, or, for
// predicates, to a 32-bit register. SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "frontend/backend/slots.h"

namespace glint::frontend {

// Where the spilled values of one round live.
struct SpillPlan {
  std::vector<VirtualRegister> group;  // one a virtual register: representative to spill, or kNoRegister
  std::vector<bool>* unspillable;      // grows: registers made by spilling, which must not spill again
};

// Rewrites every use and definition of the planned registers. Each group of 32- or 64-bit values gets a frame
// slot (4 or 8 bytes, aligned) behind program.local_bytes; a group that is a constant gets none and is moved
// into place before each use; a group of predicates becomes 0 or 1 in a new 32-bit register.
void spill(VirtualProgram& program, const Ops& ops, SpillPlan& plan);

}  // namespace glint::frontend
