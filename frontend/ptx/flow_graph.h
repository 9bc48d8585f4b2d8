// Who comes before whom in a graph of blocks: dominators, and the loops that they show.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend::ptx {

using Edges = std::vector<std::vector<BlockId>>;  // by block: where its edges lead
using Blocks = std::set<BlockId>;

// The same edges, the other way.
Edges reversed(const Edges& next);

// By block, the last block that every way from `root` to it passes; the root's is itself, kNoBlock where no
// way leads. Of the reversed edges, from the end, these are the immediate post-dominators.
std::vector<BlockId> immediate_dominators(const Edges& next, BlockId root);

// A natural loop: every way into it is through its head.
struct Loop {
  BlockId head = kNoBlock;
  Blocks body;  // with the head
};

// One loop a head, inner ones before those around them. Cycles with several ways in are none.
std::vector<Loop> natural_loops(const Edges& next, BlockId entry);

}  // namespace glint::frontend::ptx
