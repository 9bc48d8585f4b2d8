// Unrolls loops that may end before they have counted to their end.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/ptx/loop_body.h"
#include "frontend/ptx/loop_counter.h"

namespace glint::frontend::ptx {

// Puts all turns of a loop of one block, which counts to a constant and also ends when a test of its data
// fails (`and.pred p, data, count; @p bra LOOP`), in place of the loop, if all turns together are short
// enough. Each turn but the last ends in a branch out. Returns false if the loop stays.
bool unroll_with_exits(Draft& draft, VirtualProgram& program, BlockId at, LoopBody& body,
                       LoopCounter& counter);

}  // namespace glint::frontend::ptx
