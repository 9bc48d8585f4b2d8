// Loops of one block that count to an end, four turns at a time.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {

// What the hardware's assembler does to a loop that ends in `add r, r, -c; setp.ne p, r, 0; @p bra LOOP`, or
// in `add r, r, c; setp.lt.s32 p, r, end; @p bra LOOP`: four bodies behind a test that r lasts for them, two
// behind another, and the loop itself for the rest. Registers that step by a constant are computed from their
// value at the first of the four, and sums with them too, so that loads get displacements. A body that writes
// memory, waits or reads other lanes, and a long one, is taken where all lanes are known to count alike.
// Results stay bit for bit.
void unroll_loops(Draft& draft, VirtualProgram& program);

}  // namespace glint::frontend::ptx
