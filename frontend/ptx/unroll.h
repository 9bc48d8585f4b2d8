// Unrolls loops of one block that count to an end, four turns at a time.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {

// Unrolls loops as the hardware's assembler does. Such a loop ends in `add r, r, -c; setp.ne p, r, 0; @p bra
// LOOP`, or in `add r, r, c; setp.lt.s32 p, r, end; @p bra LOOP`. It becomes four bodies after a test that r
// lasts for four turns, two bodies after another test, and the loop itself for the rest. A register that
// steps by a constant is computed from its value in the first of the four bodies, and so are sums with it, so
// that loads get displacements. A body that writes memory, waits or reads other lanes, and a long body, is
// unrolled only where all lanes are known to count alike. Results stay the same to the bit.
void unroll_loops(Draft& draft, VirtualProgram& program);

}  // namespace glint::frontend::ptx
