// Keeps values across shader calls: saves them to the frame before the callee may use every register, and
// restores them afterwards.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/backend/allocate.h"

namespace glint::frontend {

// Runs before allocation. It turns predicates that are live across a call region into 32-bit values of 0 or 1
// before the region and back into predicates after it, so that only registers need saving. A predicate that
// crosses more calls than it has accesses becomes such a value in the whole program.
void keep_predicates_across_calls(VirtualProgram& program, const Ops& ops);

// Runs after allocation. It replaces every SaveLive by stores of exactly the registers that are live across
// its region and `add.u32 %r0, %r0, frame`, and every RestoreLive by `sub.u32` and the loads. Within a
// region, addresses in the frame are lowered by the frame's size. It sets program.local_bytes to the frame's
// size: variables, spills, then one save area that all regions share (they do not nest), rounded up to 16
// bytes.
void expand_calls(VirtualProgram& program, Allocation& allocation, const Ops& ops);

}  // namespace glint::frontend
