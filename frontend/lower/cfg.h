// Describes the control-flow graph of one function: reachable blocks, dominators, and which construct ends
// where.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "frontend/spirv/module.h"
#include "frontend/virtual_program.h"

namespace glint::frontend {

// Describes a region whose lanes meet again. It is a selection or loop, which ends at its merge block, or the
// part of a loop before its continue target, which ends at that target.
struct Construct {
  uint32_t header = 0;  // index of a block
  bool is_continue = false;
};

// Numbers the blocks in module order. Block 0 is the entry.
class ControlGraph {
 public:
  explicit ControlGraph(const Function& function);

  size_t num_blocks() const { return function_.blocks.size(); }
  const Block& block(uint32_t b) const { return function_.blocks[b]; }
  uint32_t index_of(Id label) const { return index_.at(label); }
  const std::vector<uint32_t>& reachable() const { return reachable_; }  // in module order
  bool is_reachable(uint32_t b) const { return depth_[b] != 0; }
  bool dominates(uint32_t a, uint32_t b) const;  // every block dominates itself
  std::optional<uint32_t> only_predecessor(uint32_t b) const;

  // Return the merge block and the continue target of header b if lanes can meet there. They are empty when b
  // has none, when nothing reaches it, and when a loop's header is its own continue target.
  std::optional<uint32_t> merge_of(uint32_t b) const;
  std::optional<uint32_t> continue_of(uint32_t b) const;
  // Returns the constructs that end at block b, innermost first.
  const std::vector<Construct>& constructs_ending_at(uint32_t b) const { return ends_[b]; }
  // Returns whether b lies in the construct, before its end.
  bool contains(const Construct& construct, uint32_t b) const;

 private:
  std::vector<uint32_t> reverse_postorder() const;
  void find_dominators();
  void find_ends();

  const Function& function_;
  std::map<Id, uint32_t> index_;
  std::vector<std::vector<uint32_t>> predecessors_;  // reachable ones, each once
  std::vector<uint32_t> reachable_;
  std::vector<uint32_t> dominator_;  // immediate dominator
  std::vector<uint32_t> depth_;      // in the dominator tree: 1 for the entry, 0 for unreachable blocks
  std::vector<std::vector<Construct>> ends_;  // constructs that end at each block
};

// Returns the join of the construct with that header.
BlockId cfg_join(const std::vector<std::pair<Construct, BlockId>>& joins, uint32_t header);

}  // namespace glint::frontend
