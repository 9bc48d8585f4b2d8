// Fuses operations on words into the instructions that the hardware's assembler makes of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/virtual_program.h"

namespace glint::frontend::ptx {

// Makes these changes, which leave results the same to the bit. Source: machine code of kernels for sm_90
// (bench/probes).
//   sums        add x, a, b; add y, x, c                    -> add3 y, a, b, c; with sub: addsub, subsub
//   products    mul.lo x, a, 7; sub y, b, x                 -> mad.lo y, a, -7, b
//   shifts      shr x, a, 5; add y, x, b                    -> shradd y, a, 5, b
//   bounds      add x, a, b; min y, x, c                    -> addmin y, a, b, c; max as well
//   logic       and, or, xor, not of up to three words      -> lop3
//   high words  mul.wide x, a, b; shr.u64 y, x, 38; cvt z   -> mul.hi y, a, b; shr.u32 z, y, 6
//   extensions  cvt.u64.u32 x, a; and.b64 y, x, 1020        -> and.b32 x, a, 1020; cvt.u64.u32 y, x
//   strides     mul.wide x, a, 16; shl.b64 y, x, 2          -> mul.wide y, a, 64
//   wide sums   mul.lo.u64 x, a, b; add.u64 y, x, c         -> mad.lo.u64 y, a, b, c
//               shl.b64 x, a, 2; add.u64 y, x, b            -> shladd.u64 y, a, 2, b
//   conversions and.b32 x, a, 255; cvt.rn.f32.u32 y, x      -> cvt.rn.f32.u8 y, a; 65535 as well
//   reductions  atom x, ... where nothing reads x           -> red
// It runs when every register that is read has been written on every path, and products have been fused into
// sums.
void fuse_words(VirtualProgram& program);

}  // namespace glint::frontend::ptx
