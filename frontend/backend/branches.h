// Encoded blocks, and the removal of control flow that they do not need.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "frontend/backend/slots.h"
#include "isa/inst.h"

namespace glint::frontend {

// An encoded instruction whose label is still a block.
struct Coded {
  isa::Inst inst;
  isa::Line line;
  BlockId target = kNoBlock;
};
using Code = std::vector<std::vector<Coded>>;  // one a block, in layout order

// To a fixed point:
//   branches to branches go straight to the end; branches to the next instruction disappear
//   `@p bra A; bra B; A:` becomes `@!p bra B; A:`
//   unreachable blocks are emptied; a block that only its predecessor in layout enters joins that one
//   `ssy M` and the `join` at M disappear when all lanes reach M over one edge out of the block of the ssy:
//   they have never parted
// Last, a loop that tests at its top gets a second test at its bottom, which saves a branch an iteration.
void clean_branches(Code& code, const Ops& ops);

}  // namespace glint::frontend
