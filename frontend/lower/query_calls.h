// Ray queries whose rays are walked in code: rq.proceed as a call that keeps no register.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/virtual_program.h"

namespace glint::frontend {

// Makes a call region of each rq.proceed, so that values that live across it lie in the frame meanwhile.
void make_queries_calls(VirtualProgram& program);

}  // namespace glint::frontend
