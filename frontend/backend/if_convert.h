// Short selections become guarded instructions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/backend/slots.h"

namespace glint::frontend {

// Replaces `ssy M; @!p bra M; a few instructions; M: join` and its two-armed form by the arms' instructions
// under guards, when nothing in them steers lanes, calls or touches rays. Two moves to one register become a
// selp. The block at M joins the one of the branch, so the scheduler sees one long run. Choice: one arm of up
// to 4 instructions, two of up to 6 together: about what ssy, bra, bra and join cost.
void convert_selections(VirtualProgram& program, const Ops& ops);

}  // namespace glint::frontend
