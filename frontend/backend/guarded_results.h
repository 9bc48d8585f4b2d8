// Lets instructions write under a guard what selections would choose.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/backend/slots.h"

namespace glint::frontend {

// Turns `op x, ...; selp r, x, y, p` into `mov r, y; @p op r, ...`, where only the selection reads x and y
// ends there, so that r takes y's register and the move disappears. If y is r itself, no move is needed.
// Source: machine code of kernels for sm_90 (bench/unseen): the assembler guards popc, sums and moves in this
// way.
void guard_selected_results(VirtualProgram& program, const Ops& ops);

}  // namespace glint::frontend
