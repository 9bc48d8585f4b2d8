// Places phis by iterated dominance frontiers, as described by R. Cytron et al., "Efficiently Computing
// Static Single Assignment Form and the Control Dependence Graph" (1991).
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/phi_places.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace glint::frontend {

bool Definitions::meet_at(BlockId block) const {
  return std::binary_search(phis_.begin(), phis_.end(), block);
}

BlockId Definitions::at_end_of(BlockId block) const {
  const auto behind =
      std::upper_bound(stretches_.begin(), stretches_.end(), (*positions_)[block],
                       [](uint32_t position, const Stretch& each) { return position < each.first; });
  return behind == stretches_.begin() ? kNoBlock : std::prev(behind)->block;
}

PhiPlaces::PhiPlaces(const Edges& next)
    : dominator_(immediate_dominators(next, 0)),
      first_(next.size(), 0),
      end_(next.size(), 0),
      frontier_(next.size()),
      defined_in_(next.size(), 0),
      phi_in_(next.size(), 0) {
  number_tree();
  find_frontiers(next);
}

bool PhiPlaces::dominates(BlockId above, BlockId block) const {
  return first_[above] <= first_[block] && first_[block] < end_[above];
}

// Walks over the tree of dominators, so that what a block dominates has positions in a row.
void PhiPlaces::number_tree() {
  Edges children(dominator_.size());
  for (BlockId b = 1; b < dominator_.size(); ++b)
    if (dominator_[b] != kNoBlock) children[dominator_[b]].push_back(b);
  uint32_t position = 0;
  std::vector<std::pair<BlockId, size_t>> stack{{0, 0}};  // block, next child to visit
  first_[0] = position++;
  while (!stack.empty()) {
    auto& [block, at] = stack.back();
    if (at == children[block].size()) {
      end_[block] = position;
      stack.pop_back();
      continue;
    }
    const BlockId child = children[block][at++];
    first_[child] = position++;
    stack.push_back({child, 0});
  }
}

void PhiPlaces::find_frontiers(const Edges& next) {
  const Edges before = reversed(next);
  for (BlockId b = 0; b < next.size(); ++b) {
    if (dominator_[b] == kNoBlock) continue;
    for (BlockId way : before[b]) {
      if (dominator_[way] == kNoBlock) continue;
      for (; way != dominator_[b]; way = dominator_[way]) {
        if (!frontier_[way].empty() && frontier_[way].back() == b) break;  // So have those above it.
        frontier_[way].push_back(b);
      }
    }
  }
}

// Returns the last block with a store that comes before each open load on every way, or kNoBlock. The
// variable is live only in what that block dominates: a way from elsewhere to a load passes the store.
BlockId PhiPlaces::last_store_before(const AccessedBlocks& accesses) const {
  const auto by_position = [&](BlockId a, BlockId b) { return first_[a] < first_[b]; };
  const auto [lowest, highest] =
      std::minmax_element(accesses.open_loads.begin(), accesses.open_loads.end(), by_position);
  BlockId last = kNoBlock;
  for (const BlockId b : accesses.stores) {
    // A block that loads first is at best the first of the loads, and its store comes too late for that.
    if (first_[b] >= first_[*lowest] || first_[*highest] >= end_[b]) continue;
    if (last == kNoBlock || first_[last] < first_[b]) last = b;
  }
  return last;
}

Definitions PhiPlaces::definitions(const AccessedBlocks& accesses) {
  Definitions out;
  out.positions_ = &first_;
  if (accesses.open_loads.empty()) return out;
  ++query_;
  const BlockId top = last_store_before(accesses);
  std::vector<BlockId> blocks = accesses.stores;
  for (const BlockId b : blocks) defined_in_[b] = query_;
  for (size_t i = 0; i < blocks.size(); ++i) {
    for (const BlockId b : frontier_[blocks[i]]) {
      if (phi_in_[b] == query_ || (top != kNoBlock && (b == top || !dominates(top, b)))) continue;
      phi_in_[b] = query_;
      out.phis_.push_back(b);
      if (std::exchange(defined_in_[b], query_) != query_) blocks.push_back(b);
    }
  }
  std::sort(out.phis_.begin(), out.phis_.end());
  std::sort(blocks.begin(), blocks.end(), [&](BlockId a, BlockId b) { return first_[a] < first_[b]; });
  std::vector<BlockId> around;
  const auto leave = [&](uint32_t position) {
    while (!around.empty() && end_[around.back()] <= position) {
      const uint32_t behind = end_[around.back()];
      around.pop_back();
      out.stretches_.push_back({behind, around.empty() ? kNoBlock : around.back()});
    }
  };
  for (const BlockId b : blocks) {
    leave(first_[b]);
    out.stretches_.push_back({first_[b], b});
    around.push_back(b);
  }
  leave(uint32_t(first_.size()));
  return out;
}

}  // namespace glint::frontend
