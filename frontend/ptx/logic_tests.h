// Makes one instruction of logic and the comparison of its result with 0.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/virtual_program.h"

namespace glint::frontend::ptx {

// Makes these changes, which leave results the same to the bit. Source: machine code of small programs for
// sm_90 (assembler of CUDA 13.0), where LOP3 writes a predicate.
//   and.b32 x, a, 3; setp.eq.s32 p, x, 0                   -> lop3.eq p, a, 3; ne, and other logic as well
//   the same where another instruction reads x, in a block -> lop3.both x|q, a, 3; not p, q
// It runs after words are fused (fusion.h).
void test_logic(VirtualProgram& program);

}  // namespace glint::frontend::ptx
