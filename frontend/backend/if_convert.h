// Turns short selections into guarded instructions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/backend/slots.h"

namespace glint::frontend {

// Replaces `ssy M; @!p bra M; a few instructions; M: join`, and its form with two arms, by the arms'
// instructions under guards. It does so when no instruction in the arms steers lanes, calls or touches rays.
// Two moves to one register become a selp. The block at M is appended to the block of the branch, so the
// scheduler sees one long run. Choice: an arm has up to 4 instructions, and two arms together have up to 6,
// which is about the cost of ssy, bra, bra and join. With `like_an_assembler` arms may be as long as those
// that the assembler of the hardware guards.
void convert_selections(VirtualProgram& program, const Ops& ops, bool like_an_assembler);

}  // namespace glint::frontend
