// Changes a program as the hardware's assembler changes PTX on the way to machine code, as far as it shows in
// counts of instructions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {

// Ends lanes that branch to the end of the kernel where they are. This takes one instruction and needs no
// region in which lanes meet.
void exit_at_branches(Draft& draft);

// Makes these changes, which leave results the same to the bit (loops: unroll.h). Source: counts of executed
// instructions of fourteen kernels on an H200, and the machine instructions of single ops
// (docs/validation.md).
//   predicates  setp p, a, b; and.pred q, p, r              -> setp.and q, a, b, r; or.pred, xor.pred as well
//   products    mul.wide x, a, b; add y, x, c; add z, x, d  -> mad.wide y, a, b, c; mad.wide z, a, b, d;
//               mul.lo and shl as well
//   negations   mul y, a, b; neg z, y                       -> mul z, na, b
//               where `neg na, a` stands after the definition of a, outside of the loop
//   loads       ld.shared of 2 or 4 consecutive words at a place known to be aligned -> one load of a vector
// It runs when every register that is read has been written on every path.
void shape_for_machine(VirtualProgram& program);

}  // namespace glint::frontend::ptx
