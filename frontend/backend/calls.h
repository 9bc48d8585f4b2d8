// Values across shader calls: what is saved to the frame before the callee may use every register, and
// restored. SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/backend/allocate.h"

namespace glint::frontend {

// Before allocation: predicates that are live across a call region become 32-bit values of 0 or 1 in front of
// it and predicates again behind it, so that only registers need saving. Those that cross more calls than
// they have accesses become such values everywhere.
void keep_predicates_across_calls(VirtualProgram& program, const Ops& ops);

// After allocation: replaces every SaveLive by stores of exactly the registers that are live across its
// region and `add.u32 %r0, %r0, frame`, and every RestoreLive by `sub.u32` and the loads. Addresses in the
// frame that stand inside a region are lowered by the frame's size. Sets program.local_bytes to the frame:
// variables, spills, then one save area that all regions share (they do not nest), rounded up to 16 bytes.
void expand_calls(VirtualProgram& program, Allocation& allocation, const Ops& ops);

}  // namespace glint::frontend
