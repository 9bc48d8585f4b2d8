// Does work on parts of words and of pairs as the hardware's assembler does.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/virtual_program.h"

namespace glint::frontend::ptx {

// Makes these changes, which leave results the same to the bit. Source: machine code of small programs for
// sm_90 (assembler of CUDA 13.0).
//   short words   and.b16, or.b16, xor.b16, comparisons and conversions of 16 bits whose sources are known to
//                 have no higher bits                          -> those of 32 bits, or nothing
//   parts         shr x, a, 24; cvt.rn.f32.u32 y, x            -> cvt.rn.f32.u8.b3 y, a; 16 bits, and bfe
//   funnel shifts shl x, a, 7; shr y, b, 25; or z, x, y        -> shf.l.wrap z, b, a, 7; add and xor as well
//   low words     shr.u64 x, a, 9; cvt.u32.u64 y, x            -> shr.low.u64 y, a, 9
//   halves        logic and shifts of 64 bits of which a half is known -> and.half.b64 and so on
//   pairs         cvt.u64.u32 of a and b; shl.b64 x, b, 32; or -> pack.b64 {a, b}
//   wide products mul.lo.u64 of two extended words             -> mul.wide
//   places        cvt.u32.u64 of a wide sum                    -> the sum of words
//   addresses     add.u64 x, a, 512; ld [x - 256]              -> ld [a + 256], if a holds the same there
// The first function runs before words are fused (fusion.h), and the second one after it.
void narrow_words(VirtualProgram& program);
void narrow_pairs(VirtualProgram& program);

}  // namespace glint::frontend::ptx
