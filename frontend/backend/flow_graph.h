// Computes dominators and natural loops of a graph of blocks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend {

using Edges = std::vector<std::vector<BlockId>>;  // by block: the blocks to which its edges lead
using Blocks = std::set<BlockId>;

// Returns the same edges in the other direction.
Edges reversed(const Edges& next);

// Returns, for each block, the last other block that every way from `root` to it passes. The result is the
// root itself for the root, and kNoBlock for a block that no way reaches. With reversed edges and the end as
// root, these are the immediate post-dominators.
std::vector<BlockId> immediate_dominators(const Edges& next, BlockId root);

// Holds a natural loop, which is entered only through its head.
struct Loop {
  BlockId head = kNoBlock;
  Blocks body;  // contains the head
};

// Returns one loop for each head; inner loops come before the loops around them. A cycle with several entries
// is not a natural loop.
std::vector<Loop> natural_loops(const Edges& next, BlockId entry);

}  // namespace glint::frontend
