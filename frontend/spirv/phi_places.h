// Finds the blocks of a function where a variable may need a phi, and the definition that each block sees.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "frontend/backend/flow_graph.h"

namespace glint::frontend {

// Lists the blocks that access a variable. Each block is reachable and stands once.
struct AccessedBlocks {
  std::vector<BlockId> stores;
  std::vector<BlockId> open_loads;  // load the variable before they store it
};

// Says which block gives a variable the value that others see: one that stores it, or one where phis may be
// needed. It holds two numbers for each such block.
class Definitions {
 public:
  // Returns whether several definitions meet at the begin of a block.
  bool meet_at(BlockId block) const;

  // Returns the block whose definition holds at the end of a block, or kNoBlock when that is the variable's
  // value at first.
  BlockId at_end_of(BlockId block) const;

 private:
  friend class PhiPlaces;
  struct Stretch {
    uint32_t first = 0;  // position in the walk over the tree of dominators
    BlockId block = kNoBlock;
  };
  const std::vector<uint32_t>* positions_ = nullptr;  // those of PhiPlaces, which must live longer
  std::vector<BlockId> phis_;                         // sorted
  std::vector<Stretch> stretches_;                    // sorted by `first`; each lasts until the next
};

// Knows the dominators of a function's blocks. Block 0 is the entry.
class PhiPlaces {
 public:
  explicit PhiPlaces(const Edges& next);

  // Returns the definitions of a variable. Phis may stand where its stores' iterated dominance frontiers lie,
  // and never where a store must come before each open load; which of them are loaded is left to the caller.
  // The time grows with the stores and the returned phis, not with the function.
  Definitions definitions(const AccessedBlocks& accesses);

  // Returns the block that every way to `block` passes last. `block` is reachable and not the entry.
  BlockId dominator(BlockId block) const { return dominator_[block]; }

 private:
  bool dominates(BlockId above, BlockId block) const;  // every block dominates itself
  void number_tree();
  void find_frontiers(const Edges& next);
  BlockId last_store_before(const AccessedBlocks& accesses) const;

  std::vector<BlockId> dominator_;
  std::vector<uint32_t> first_, end_;           // by block: the positions of what it dominates
  std::vector<std::vector<BlockId>> frontier_;  // by block
  std::vector<uint32_t> defined_in_, phi_in_;   // by block: number of the query that put it into its result
  uint32_t query_ = 0;
};

}  // namespace glint::frontend
