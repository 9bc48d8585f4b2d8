// Lets a core regroup lanes between a trace and the hit shaders that it calls.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/virtual_program.h"

namespace glint::frontend {

// Puts an rt.reorder before each call.sbt.hit (BackendOptions::reorder_traces).
void reorder_before_hit_shaders(VirtualProgram& program);

}  // namespace glint::frontend
