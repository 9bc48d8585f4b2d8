// A kernel as a graph of blocks with explicit ends, before lanes that part are told where to meet.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend::ptx {

struct DraftBlock {
  enum class End : uint8_t { Goto, Branch, Exit };
  std::string name;
  std::vector<VirtualInst> code;
  End end = End::Exit;
  VirtualRegister condition = kNoRegister;  // Branch: lanes where it holds go to `taken`
  bool negate = false;
  bool uniform = false;  // Branch: the text promises that lanes agree
  BlockId taken = kNoBlock;
  BlockId next = kNoBlock;  // Goto; Branch: the other lanes
  isa::Line line;           // of the end

  std::vector<BlockId> successors() const {
    if (end == End::Exit) return {};
    if (end == End::Goto) return {next};
    return {taken, next};
  }
};

struct Draft {
  std::vector<DraftBlock> blocks;  // any order
  std::vector<BlockId>
      layout;  // the order in memory; the first is the entry, which ends in a Goto; none leads to it
};

// Where lanes part, and the place where they meet again at the latest: PTX has no instructions for that.
//
// A branch X whose lanes may part has P, its immediate post-dominator. S(P) are those branches and all blocks
// that they reach before P; every edge that leaves S(P) leads to P. So `ssy` stands on the edges into S(P),
// `join` on those from it to P, and each ssy is completed by one join. Sets that overlap are made to nest:
// see the .cpp file. Branches to early ends do not count as ways round P: lanes that have ended need not be
// waited for.
void add_reconvergence(Draft& draft);

// The blocks in layout order, with branches where the next block is not the next place.
std::vector<VirtualBlock> lay_out(Draft draft);

}  // namespace glint::frontend::ptx
