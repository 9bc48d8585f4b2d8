// Unrolls loops of one block that count to an end.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {

// Unrolls loops as the hardware's assembler does. Such a loop ends in `add r, r, c; setp p, r, end; @p bra
// LOOP`. If r starts as a constant, so that the number of turns is known, and all turns together are short
// enough, they become one run of instructions, in which r and other registers that step from constants are
// constants. Otherwise a loop that counts up to a bound (`setp.lt.s32`, `.u32`) or down to zero
// (`setp.ne.s32`) becomes four bodies after a test that r lasts for four turns, two bodies after another
// test, and the loop itself for the rest. A register that steps by a constant is computed from its value in
// the first of the bodies, and so are sums with it, so that loads get displacements. A body that writes
// memory, waits or reads other lanes is unrolled only where all lanes are known to count alike. Results stay
// the same to the bit.
void unroll_loops(Draft& draft, VirtualProgram& program);

}  // namespace glint::frontend::ptx
