// Computes dominators by iteration over the graph, and finds loops by their back edges.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/flow_graph.h"

#include <algorithm>
#include <map>
#include <utility>

namespace glint::frontend {
namespace {

std::vector<BlockId> postorder_of(const Edges& next, BlockId root) {
  std::vector<BlockId> postorder;
  std::vector<bool> seen(next.size());
  std::vector<std::pair<BlockId, size_t>> stack{{root, 0}};
  seen[root] = true;
  while (!stack.empty()) {
    auto& [b, at] = stack.back();
    if (at == next[b].size()) {
      postorder.push_back(b);
      stack.pop_back();
    } else if (const BlockId n = next[b][at++]; !seen[n]) {
      seen[n] = true;
      stack.emplace_back(n, 0);
    }
  }
  return postorder;
}

bool dominates(const std::vector<BlockId>& dominator, BlockId above, BlockId b) {
  while (b != above && b != kNoBlock && dominator[b] != b) b = dominator[b];
  return b == above;
}

}  // namespace

Edges reversed(const Edges& next) {
  Edges out(next.size());
  for (BlockId b = 0; b < next.size(); ++b)
    for (BlockId n : next[b]) out[n].push_back(b);
  return out;
}

// Uses K. Cooper, T. Harvey, K. Kennedy, "A simple, fast dominance algorithm" (2001).
std::vector<BlockId> immediate_dominators(const Edges& next, BlockId root) {
  const Edges before = reversed(next);
  const std::vector<BlockId> postorder = postorder_of(next, root);
  std::vector<size_t> number(next.size(), 0);
  for (size_t i = 0; i < postorder.size(); ++i) number[postorder[i]] = i;
  std::vector<BlockId> dominator(next.size(), kNoBlock);
  dominator[root] = root;
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = postorder.size() - 1; i-- > 0;) {
      const BlockId b = postorder[i];
      BlockId meet = kNoBlock;
      for (BlockId n : before[b]) {
        if (dominator[n] == kNoBlock) continue;
        if (meet == kNoBlock) meet = n;
        for (BlockId other = n; meet != other;) {
          while (number[meet] < number[other]) meet = dominator[meet];
          while (number[other] < number[meet]) other = dominator[other];
        }
      }
      if (meet == kNoBlock || dominator[b] == meet) continue;
      dominator[b] = meet;
      changed = true;
    }
  }
  return dominator;
}

std::vector<Loop> natural_loops(const Edges& next, BlockId entry) {
  const Edges before = reversed(next);
  const std::vector<BlockId> dominator = immediate_dominators(next, entry);
  std::map<BlockId, Blocks> bodies;
  for (BlockId b = 0; b < next.size(); ++b)
    for (BlockId head : next[b]) {
      if (dominator[b] == kNoBlock || !dominates(dominator, head, b)) continue;
      Blocks& body = bodies[head];
      body.insert(head);
      std::vector<BlockId> work{b};
      while (!work.empty()) {
        const BlockId at = work.back();
        work.pop_back();
        if (dominator[at] == kNoBlock || !body.insert(at).second) continue;
        work.insert(work.end(), before[at].begin(), before[at].end());
      }
    }
  std::vector<Loop> loops;
  for (auto& [head, body] : bodies) loops.push_back({head, std::move(body)});
  std::stable_sort(loops.begin(), loops.end(),
                   [](const Loop& a, const Loop& b) { return a.body.size() < b.body.size(); });
  return loops;
}

}  // namespace glint::frontend
