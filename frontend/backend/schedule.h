// Orders the instructions of each block so that long latencies overlap without exceeding the available
// registers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "frontend/backend/slots.h"

namespace glint::frontend {

// Performs list scheduling on the critical path. Only ops that neither steer lanes nor touch rays or calls
// move. None of them moves across an op that does so, or inside a region from SaveLive to RestoreLive. Loads
// and stores of one space keep their order unless both are loads or both address the frame at displacements
// that do not overlap. `guard_latency` is the number of extra cycles assumed before a predicate can guard an
// instruction. With `like_an_assembler` nothing moves across an op with a slow path (slow_paths.h), and a run
// that can stay within as few registers as an H200's assembler takes does. Other runs take as few as do not
// make them much longer.
void schedule(VirtualProgram& program, uint32_t max_registers, uint32_t guard_latency = 0,
              bool like_an_assembler = false);

}  // namespace glint::frontend
