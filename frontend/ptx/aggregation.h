// Lets one lane of a warp do the atomics of all lanes that meet in one word.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/virtual_program.h"

namespace glint::frontend::ptx {

// Rewrites atomics on integers of global memory whose address is the same for all lanes of a warp, as the
// hardware's assembler does. Source: machine code of kernels for sm_90 (bench/probes). One lane, the highest,
// adds up, or finds the least or the most of, what all lanes have; `redux` does that, or `popc` where all
// lanes have the same constant. An atomic whose old value is read is rewritten only if it adds a constant: a
// shuffle hands the old value to all lanes, and each adds what the lanes below it have added. Results stay
// the same, because lanes take turns from the lowest on.
void aggregate_atomics(VirtualProgram& program);

}  // namespace glint::frontend::ptx
