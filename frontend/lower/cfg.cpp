// Computes dominators by the iterative method of Cooper, Harvey and Kennedy, "A Simple, Fast Dominance
// Algorithm" (2001).
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/cfg.h"

#include <algorithm>
#include <cstdint>

#include "base/check.h"

namespace glint::frontend {

ControlGraph::ControlGraph(const Function& function)
    : function_(function),
      predecessors_(function.blocks.size()),
      dominator_(function.blocks.size(), 0),
      depth_(function.blocks.size(), 0) {
  for (uint32_t b = 0; b < num_blocks(); ++b) index_[block(b).label] = b;
  find_dominators();
  find_ends();
}

std::vector<uint32_t> ControlGraph::reverse_postorder() const {
  std::vector<uint32_t> order;
  std::vector<uint8_t> seen(num_blocks(), 0);
  std::vector<std::pair<uint32_t, size_t>> stack{{0, 0}};  // block, next successor to visit
  seen[0] = 1;
  while (!stack.empty()) {
    const uint32_t b = stack.back().first;
    const std::vector<Id> next = block(b).successors();
    if (stack.back().second == next.size()) {
      order.push_back(b);
      stack.pop_back();
      continue;
    }
    const uint32_t to = index_of(next[stack.back().second++]);
    if (!seen[to]) {
      seen[to] = 1;
      stack.push_back({to, 0});
    }
  }
  std::reverse(order.begin(), order.end());
  return order;
}

void ControlGraph::find_dominators() {
  const std::vector<uint32_t> order = reverse_postorder();
  constexpr uint32_t kNone = 0xffff'ffff;
  std::vector<uint32_t> position(num_blocks(), kNone);
  for (uint32_t i = 0; i < order.size(); ++i) position[order[i]] = i;
  for (uint32_t b : order)
    for (Id to : block(b).successors()) {
      auto& list = predecessors_[index_of(to)];
      if (std::find(list.begin(), list.end(), b) == list.end()) list.push_back(b);
    }
  std::fill(dominator_.begin(), dominator_.end(), kNone);
  dominator_[0] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (uint32_t b : order) {
      if (b == 0) continue;
      uint32_t common = kNone;
      for (uint32_t p : predecessors_[b]) {
        if (dominator_[p] == kNone) continue;
        if (common == kNone) common = p;
        for (uint32_t other = p; common != other;) {
          while (position[common] > position[other]) common = dominator_[common];
          while (position[other] > position[common]) other = dominator_[other];
        }
      }
      if (common != dominator_[b]) dominator_[b] = common, changed = true;
    }
  }
  for (uint32_t b : order) depth_[b] = b == 0 ? 1 : depth_[dominator_[b]] + 1;
  for (uint32_t b = 0; b < num_blocks(); ++b)
    if (is_reachable(b)) reachable_.push_back(b);
}

bool ControlGraph::dominates(uint32_t a, uint32_t b) const {
  if (!is_reachable(a) || !is_reachable(b)) return false;
  while (depth_[b] > depth_[a]) b = dominator_[b];
  return a == b;
}

std::optional<uint32_t> ControlGraph::only_predecessor(uint32_t b) const {
  if (predecessors_[b].size() != 1) return std::nullopt;
  return predecessors_[b][0];
}

std::optional<uint32_t> ControlGraph::merge_of(uint32_t b) const {
  if (block(b).merge == spv::Op::OpNop) return std::nullopt;
  const uint32_t merge = index_of(block(b).merge_block);
  return is_reachable(merge) ? std::optional(merge) : std::nullopt;
}

std::optional<uint32_t> ControlGraph::continue_of(uint32_t b) const {
  if (block(b).merge != spv::Op::OpLoopMerge) return std::nullopt;
  const uint32_t target = index_of(block(b).continue_block);
  return is_reachable(target) && target != b ? std::optional(target) : std::nullopt;
}

void ControlGraph::find_ends() {
  ends_.resize(num_blocks());
  for (uint32_t header : reachable_) {
    if (const auto merge = merge_of(header)) ends_[*merge].push_back({header, false});
    if (const auto target = continue_of(header)) ends_[*target].push_back({header, true});
  }
  for (std::vector<Construct>& ends : ends_)
    std::stable_sort(ends.begin(), ends.end(), [&](const Construct& x, const Construct& y) {
      return depth_[x.header] > depth_[y.header];
    });
}

bool ControlGraph::contains(const Construct& construct, uint32_t b) const {
  if (!dominates(construct.header, b)) return false;
  const auto merge = merge_of(construct.header);
  if (merge && dominates(*merge, b)) return false;
  if (!construct.is_continue) return true;
  return !dominates(*continue_of(construct.header), b);
}

BlockId cfg_join(const std::vector<std::pair<Construct, BlockId>>& joins, uint32_t header) {
  for (const auto& [construct, id] : joins)
    if (construct.header == header) return id;
  GLINT_PANIC("no join for the construct of block {}", header);
}

}  // namespace glint::frontend
