// Turns rq.proceed into a call that preserves no register, for ray queries whose rays are traversed in shader
// code.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/virtual_program.h"

namespace glint::frontend {

// Makes a call region of each rq.proceed, so that values that live across it are in the frame during the
// call.
void make_queries_calls(VirtualProgram& program);

}  // namespace glint::frontend
