// Orders the instructions of each block so that long latencies overlap, without needing more registers than
// there are. SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/backend/slots.h"

namespace glint::frontend {

// List scheduling on the critical path. Only ops that neither steer lanes nor touch rays or calls move, and
// none moves across one that does, nor inside a SaveLive..RestoreLive region. Loads and stores of one space
// keep their order unless both are loads or both address the frame at displacements that do not overlap.
// `guard_latency`: cycles later that a predicate guards an instruction than it can be read.
void schedule(VirtualProgram& program, uint32_t max_registers, uint32_t guard_latency = 0);

}  // namespace glint::frontend
