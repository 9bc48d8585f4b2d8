// Holds a kernel as a graph of blocks with explicit ends, before diverging lanes are told where to meet.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend::ptx {

struct DraftBlock {
  enum class End : uint8_t { Goto, Branch, Exit };
  std::string name;
  std::vector<VirtualInst> code;
  End end = End::Exit;
  VirtualRegister condition = kNoRegister;  // Branch: lanes in which it holds go to `taken`
  bool negate = false;
  bool uniform = false;  // Branch: the text promises that lanes agree
  BlockId taken = kNoBlock;
  BlockId next = kNoBlock;  // Goto; Branch: for the other lanes
  isa::Line line;           // line of the end
  bool returns = false;     // Exit: goes back to the caller of the function, and does not end the lanes
  bool may_unroll = true;   // false: the text forbids to copy the loop that the block heads

  std::vector<BlockId> successors() const {
    if (end == End::Exit) return {};
    if (end == End::Goto) return {next};
    return {taken, next};
  }
};

struct Draft {
  std::vector<DraftBlock> blocks;  // any order
  // This is the order in memory. The first block is the entry, which ends in a Goto and to which no block
  // leads.
  std::vector<BlockId> layout;
};

// Removes the yields that do not lie in a loop, where no lane waits.
void keep_yields_in_loops(Draft& draft);

// Finds where lanes diverge and the place where they meet again at the latest, for which PTX has no
// instructions.
//
// A branch X whose lanes may diverge has an immediate post-dominator P. S(P) is the set of those branches and
// all blocks that they reach before P, so every edge that leaves S(P) leads to P. Therefore `ssy` stands on
// the edges into S(P), `join` stands on the edges from S(P) to P, and each ssy is completed by one join. Sets
// that overlap are made to nest (see the .cpp file). Branches to early ends do not count as ways round P,
// because lanes that have ended need not be waited for.
void add_reconvergence(Draft& draft);

// Returns the blocks in layout order, with a branch wherever control does not go to the next block of the
// layout.
std::vector<VirtualBlock> lay_out(Draft draft);

}  // namespace glint::frontend::ptx
