// What the hardware's assembler does to PTX on the way to machine code, and what shows in counts of
// instructions. SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {

// Lanes that branch to the end of the kernel end where they are: no region to meet in, one instruction.
void exit_at_branches(Draft& draft);

// Results stay bit for bit what they were. Source: counts of executed instructions of fourteen kernels on an
// H200, and the machine instructions of single ops (docs/validation.md). Loops: unroll.h.
//   predicates  setp p, a, b; and.pred q, p, r              -> setp.and q, a, b, r; or.pred, xor.pred as well
//   products    mul.wide x, a, b; add y, x, c; add z, x, d  -> mad.wide y, a, b, c; mad.wide z, a, b, d;
//   mul.lo, shl as well negations   mul y, a, b; neg z, y -> mul z, na, b with neg na, a where a is computed,
//   out of the loop that a comes into loads       ld.shared of 2 or 4 words that follow each other at a place
//   known to be aligned -> one of a vector
// Runs when every register that is read has been written on every path.
void shape_for_machine(VirtualProgram& program);

}  // namespace glint::frontend::ptx
