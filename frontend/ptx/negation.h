// Makes negations of floats part of the ops that read them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/virtual_program.h"

namespace glint::frontend::ptx {

// Makes these changes, which leave results the same to the bit. The instructions of the machine have a sign
// for each source.
//   neg x, a; mul y, x, b            -> nmul y, a, b
//   mul x, a, b; neg y, x            -> nmul y, a, b
//   neg x, a; add y, x, b            -> sub y, b, a; sub y, b, x -> add y, b, a
//   neg x, a; fma y, x, b, c         -> nfma y, a, b, c
//   neg x, c; fma y, a, b, x         -> fms y, a, b, c
void fold_negations(VirtualProgram& program);

}  // namespace glint::frontend::ptx
