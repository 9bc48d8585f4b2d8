// Moves values out of registers: to a slot of the frame, to a constant that is moved again at each use, or,
// for predicates, to a 32-bit register.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "frontend/backend/slots.h"

namespace glint::frontend {

// Says where the spilled values of one round live.
struct SpillPlan {
  // Holds, for each virtual register, the representative of the group to spill, or kNoRegister.
  std::vector<VirtualRegister> group;
  std::vector<bool>* unspillable;  // grows by the registers of spill code, which must not spill again
};

// Rewrites every use and definition of the planned registers. Each group of 32- or 64-bit values gets a frame
// slot (4 or 8 bytes, aligned) after program.local_bytes. A group that is a constant gets no slot and is
// moved into place before each use. A group of predicates becomes 0 or 1 in a new 32-bit register.
void spill(VirtualProgram& program, const Ops& ops, SpillPlan& plan);

}  // namespace glint::frontend
