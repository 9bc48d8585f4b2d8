// Removes control flow that encoded blocks do not need.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "frontend/backend/slots.h"
#include "isa/inst.h"

namespace glint::frontend {

// Holds an encoded instruction whose label is still a block.
struct Coded {
  isa::Inst inst;
  isa::Line line;
  BlockId target = kNoBlock;
};
using Code = std::vector<std::vector<Coded>>;  // one vector for each block, in layout order

// Repeats these changes until nothing changes any more:
// - branches to branches go straight to the end;
// - branches to the next instruction disappear;
// - `@p bra A; bra B; A:` becomes `@!p bra B; A:`;
// - unreachable blocks are emptied;
// - a block that is entered only from the block before it is appended to that block;
// - `ssy M` and the `join` at M disappear when all lanes reach M over one edge out of the block of the ssy,
//   because these lanes have never diverged.
// After that, a loop that tests at its top gets a second test at its bottom, which saves a branch per
// iteration.
void clean_branches(Code& code, const Ops& ops);

}  // namespace glint::frontend
