// Simplifies code before scheduling: copies, fused integer arithmetic, addresses, and results that nothing
// reads.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/backend/slots.h"

namespace glint::frontend {

// Repeats these changes until nothing changes any more:
//   copies and constants   mov.b32 a, b  or 7           -> uses of a name b or 7
//   negated predicates     not.pred q, p; @q ...        -> @!p ...
//   integer multiply-add   mul.lo + add, shl + add      -> mad.lo; mul.wide, cvt, shl + add.u64 -> mad.wide
//   addresses              add.u64 a, b, 16; [a + 4]    -> [b + 20]
//   halves of packed pairs pack.b64 d, a, b; unpack {x, y}, d -> mov x, a; mov y, b
//   dead code              pure ops (loads too) whose results nothing reads are removed
// Only registers with one unguarded definition take part. Such a definition reaches all uses, and its
// operands, if they are of that kind too, still hold the same values there. Floating-point arithmetic is
// never fused or reordered.
void simplify_code(VirtualProgram& program, const Ops& ops);

// Removes pure instructions whose results nothing reads. Returns true when there were any.
bool drop_dead_code(VirtualProgram& program);

}  // namespace glint::frontend
