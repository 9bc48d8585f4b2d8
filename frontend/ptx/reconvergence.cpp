// Post-dominators, and the regions whose lanes must meet.
//
// Nesting. Let P1 lie in S(P2). If S(P1) and S(P2) overlap, S(P1) is added to S(P2): its blocks are post-dominated by
// P1, so also by P2, and edges out of it still lead into S(P2). After that any two sets are nested or disjoint: of two
// that share a block, the one whose P comes first on the way to the end lies in the other.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>

#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {
namespace {

using Blocks = std::set<BlockId>;

VirtualInst steer(const char* op, BlockId target = kNoBlock) {
  VirtualInst inst;
  inst.op = isa::op_index(op);
  inst.target = target;
  return inst;
}

class Reconvergence {
 public:
  explicit Reconvergence(Draft& draft) : draft_(draft), end_(BlockId(draft.blocks.size())) {}

  void run() {
    find_edges();
    find_post_dominators();
    find_regions();
    nest_regions();
    insert();
  }

 private:
  DraftBlock& block(BlockId b) { return draft_.blocks[b]; }

  // Edges that count: those to early ends are dropped where there is another way.
  void find_edges() {
    next_.resize(size_t{end_} + 1);
    reachable_.assign(size_t{end_} + 1, false);
    std::vector<BlockId> work{draft_.layout.front()};
    while (!work.empty()) {
      const BlockId b = work.back();
      work.pop_back();
      if (reachable_[b]) continue;
      reachable_[b] = true;
      for (BlockId n : block(b).successors()) work.push_back(n);
    }
    BlockId last_exit = end_;
    for (BlockId b : draft_.layout)
      if (reachable_[b] && block(b).end == DraftBlock::End::Exit) last_exit = b;
    const std::vector<bool> goes_on = blocks_before(last_exit);
    for (BlockId b : draft_.layout) {
      if (!reachable_[b]) continue;
      for (BlockId n : block(b).successors())
        if (!goes_on[b] || goes_on[n]) next_[b].push_back(n);
    }
    connect_ends();
  }

  // Every block gets a way to the virtual end: exits one edge, endless loops one from a block of theirs.
  void connect_ends() {
    for (BlockId b : draft_.layout)
      if (reachable_[b] && next_[b].empty()) next_[b].push_back(end_);
    while (true) {
      const std::vector<bool> ends = blocks_before(end_, true);
      const auto stuck = std::find_if(draft_.layout.begin(), draft_.layout.end(),
                                      [&](BlockId b) { return reachable_[b] && !ends[b]; });
      if (stuck == draft_.layout.end()) return;
      next_[*stuck].push_back(end_);
    }
  }

  // Which blocks have a way to `target`; with `counted`, over the edges that count.
  std::vector<bool> blocks_before(BlockId target, bool counted = false) {
    std::vector<std::vector<BlockId>> before(size_t{end_} + 1);
    for (BlockId b : draft_.layout)
      if (reachable_[b])
        for (BlockId n : counted ? next_[b] : block(b).successors()) before[n].push_back(b);
    std::vector<bool> found(size_t{end_} + 1);
    std::vector<BlockId> work{target};
    while (!work.empty()) {
      const BlockId b = work.back();
      work.pop_back();
      if (found[b]) continue;
      found[b] = true;
      work.insert(work.end(), before[b].begin(), before[b].end());
    }
    return found;
  }

  // K. Cooper, T. Harvey, K. Kennedy, "A simple, fast dominance algorithm" (2001), on the reversed graph.
  void find_post_dominators() {
    std::vector<BlockId> postorder;  // of the reversed graph from the virtual end
    std::vector<std::vector<BlockId>> before(size_t{end_} + 1);
    for (BlockId b : draft_.layout)
      for (BlockId n : next_[b]) before[n].push_back(b);
    std::vector<uint32_t> number(size_t{end_} + 1, 0);
    std::vector<std::pair<BlockId, size_t>> stack{{end_, 0}};
    std::vector<bool> seen(size_t{end_} + 1);
    seen[end_] = true;
    while (!stack.empty()) {
      auto& [b, at] = stack.back();
      if (at == before[b].size()) {
        number[b] = uint32_t(postorder.size());
        postorder.push_back(b);
        stack.pop_back();
      } else if (const BlockId n = before[b][at++]; !seen[n]) {
        seen[n] = true;
        stack.emplace_back(n, 0);
      }
    }
    post_.assign(size_t{end_} + 1, kNoBlock);
    post_[end_] = end_;
    for (bool changed = true; changed;) {
      changed = false;
      for (size_t i = postorder.size() - 1; i-- > 0;) {
        const BlockId b = postorder[i];
        BlockId meet = kNoBlock;
        for (BlockId n : next_[b]) {
          if (post_[n] == kNoBlock) continue;
          if (meet == kNoBlock) meet = n;
          for (BlockId other = n; meet != other;) {
            while (number[meet] < number[other]) meet = post_[meet];
            while (number[other] < number[meet]) other = post_[other];
          }
        }
        if (meet == kNoBlock || post_[b] == meet) continue;
        post_[b] = meet;
        changed = true;
      }
    }
  }

  bool parts_lanes(BlockId b) const {
    const DraftBlock& x = draft_.blocks[b];
    return reachable_[b] && x.end == DraftBlock::End::Branch && !x.uniform && next_[b].size() == 2 && x.taken != x.next;
  }

  void find_regions() {
    for (BlockId b : draft_.layout) {
      if (!parts_lanes(b) || post_[b] == end_) continue;
      const BlockId meet = post_[b];
      Blocks& region = regions_[meet];
      std::vector<BlockId> work{b};
      while (!work.empty()) {
        const BlockId at = work.back();
        work.pop_back();
        if (at == meet || at == end_ || !region.insert(at).second) continue;
        work.insert(work.end(), next_[at].begin(), next_[at].end());
      }
    }
  }

  static bool overlap(const Blocks& a, const Blocks& b) {
    return std::any_of(a.begin(), a.end(), [&](BlockId x) { return b.contains(x); });
  }

  void nest_regions() {
    for (bool changed = true; changed;) {
      changed = false;
      for (auto& [p1, s1] : regions_)
        for (auto& [p2, s2] : regions_) {
          if (p1 == p2 || !s2.contains(p1) || !overlap(s1, s2)) continue;
          const size_t before = s2.size();
          s2.insert(s1.begin(), s1.end());
          changed |= s2.size() != before;
        }
    }
  }

  // Meeting places of the regions that an edge enters, outermost first. `from` is a block, or with `behind_join` the
  // join of `to`, which lies in a region exactly when all of S(to) does.
  std::vector<BlockId> entered(BlockId from, BlockId to, bool behind_join) const {
    std::vector<BlockId> out;
    for (const auto& [p, s] : regions_) {
      if (!s.contains(to)) continue;
      const bool inside = behind_join ? overlap(s, regions_.at(to)) : s.contains(from);
      if (!inside) out.push_back(p);
    }
    std::sort(out.begin(), out.end(), [&](BlockId a, BlockId b) { return regions_.at(a).size() > regions_.at(b).size(); });
    return out;
  }

  BlockId new_block(std::string name, BlockId next, const isa::Line& line) {
    DraftBlock b;
    b.name = std::move(name);
    b.end = DraftBlock::End::Goto;
    b.next = next;
    b.line = line;
    draft_.blocks.push_back(std::move(b));
    return BlockId(draft_.blocks.size() - 1);
  }

  void push_all(std::vector<VirtualInst>& code, const std::vector<BlockId>& meets, const isa::Line& line) {
    for (BlockId p : meets) {
      code.push_back(steer("ssy", joins_.at(p)));
      code.back().line = line;
    }
  }

  struct Edge {
    BlockId from;
    bool taken, to_join;
    std::vector<BlockId> enters;
  };

  void insert() {
    for (const auto& [p, s] : regions_) {
      joins_[p] = new_block(block(p).name.empty() ? "" : block(p).name + "_join", p, block(p).line);
      block(joins_[p]).code.push_back(steer("join"));
    }
    const std::vector<BlockId> originals = draft_.layout;
    std::map<BlockId, std::vector<Edge>> into;
    for (BlockId b : originals) {
      if (!reachable_[b]) continue;
      const DraftBlock& x = block(b);
      for (bool taken : {true, false}) {
        if (x.end == DraftBlock::End::Exit || (taken && x.end != DraftBlock::End::Branch)) continue;
        const BlockId to = taken ? x.taken : x.next;
        const bool to_join = regions_.contains(to) && regions_.at(to).contains(b);
        into[to].push_back({b, taken, to_join, to_join ? std::vector<BlockId>{} : entered(b, to, false)});
      }
    }
    for (const auto& [to, edges] : into) connect(to, edges);
    // A block's own regions are outside those that its edge enters.
    for (const auto* pushes : {&at_end_, &on_edge_})
      for (const auto& [b, meets] : *pushes) push_all(block(b).code, meets, block(b).line);
    std::vector<BlockId> layout;
    for (BlockId b : originals) {
      if (const auto join = joins_.find(b); join != joins_.end()) layout.push_back(join->second);
      layout.push_back(b);
      for (BlockId extra : behind_[b]) layout.push_back(extra);
    }
    draft_.layout = std::move(layout);
  }

  // Leads the edges into block `to` through its join and the ssys they need.
  void connect(BlockId to, const std::vector<Edge>& edges) {
    const bool has_join = joins_.contains(to);
    const std::vector<BlockId> behind_join = has_join ? entered(to, to, true) : std::vector<BlockId>{};
    // What every way into the block enters is pushed in the block itself, just before it ends.
    const std::vector<BlockId>& first = has_join ? behind_join : edges.front().enters;
    const bool same = std::all_of(edges.begin(), edges.end(), [&](const Edge& e) { return e.to_join || e.enters == first; });
    if (same) at_end_[to] = first;
    if (has_join && !same) push_all(block(joins_[to]).code, behind_join, block(to).line);
    for (const Edge& edge : edges) {
      DraftBlock& from = block(edge.from);
      BlockId& target = edge.taken ? from.taken : from.next;
      if (edge.to_join) {
        target = joins_[to];
      } else if (!same && !edge.enters.empty()) {
        if (from.end == DraftBlock::End::Goto) {
          on_edge_[edge.from] = edge.enters;
        } else {
          const BlockId between = new_block("", to, from.line);
          push_all(block(between).code, edge.enters, block(edge.from).line);
          DraftBlock& again = block(edge.from);  // new_block may have moved it
          (edge.taken ? again.taken : again.next) = between;
          behind_[edge.from].push_back(between);
        }
      }
    }
  }

  Draft& draft_;
  const BlockId end_;                          // the virtual end
  std::vector<std::vector<BlockId>> next_;     // edges that count
  std::vector<bool> reachable_;
  std::vector<BlockId> post_;                  // immediate post-dominator
  std::map<BlockId, Blocks> regions_;          // S(P) by P
  std::map<BlockId, BlockId> joins_;           // join block of P
  std::map<BlockId, std::vector<BlockId>> at_end_, on_edge_;  // ssys that a block pushes before it ends
  std::map<BlockId, std::vector<BlockId>> behind_;  // new blocks, by the block behind which they lie
};

}  // namespace

void add_reconvergence(Draft& draft) { Reconvergence(draft).run(); }

}  // namespace glint::frontend::ptx
