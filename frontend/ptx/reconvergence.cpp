// Computes post-dominators and the regions whose lanes must meet.
//
// Nesting: let P1 lie in S(P2). If S(P1) and S(P2) overlap, S(P1) is added to S(P2). The blocks of S(P1) are
// post-dominated by P1, so also by P2, and edges out of S(P1) still lead into S(P2). After that any two sets
// are nested or disjoint: if two sets share a block, the set whose P comes first on the way to the end lies
// in the other set.
//
// Loops: a branch with both ways inside a loop is analysed within one turn of the loop. Ways out of the loop
// do not count, and all edges back to the head lead to one new block, the turn's end. There, lanes that are
// done with the turn wait for lanes that are still in it. Source: counts of executed loads of a traversal
// loop on an H200 (docs/validation.md). Lanes that leave the loop leave S(P) without its join and wait at the
// join of a region around the loop, which is_sound() checks.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "frontend/backend/flow_graph.h"
#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {
namespace {

VirtualInst steer(const char* op, BlockId target = kNoBlock) {
  VirtualInst inst;
  inst.op = isa::op_index(op);
  inst.target = target;
  return inst;
}

class Reconvergence {
 public:
  explicit Reconvergence(Draft& draft) : draft_(draft), end_(BlockId(draft.blocks.size())) {}

  // Returns the loops in which lanes diverge and do not meet before the end of the turn, so that the turn
  // needs an end block.
  std::vector<Loop> loops_without_end() {
    find_edges();
    std::vector<Loop> out;
    for (Loop& loop : natural_loops(next_, draft_.layout.front())) {
      const Edges turn = edges_of_turn(loop);
      const std::vector<BlockId> post = immediate_dominators(reversed(turn), end_);
      const bool needs = std::any_of(loop.body.begin(), loop.body.end(),
                                     [&](BlockId b) { return parts_lanes(b, turn) && post[b] == end_; });
      if (needs) out.push_back(std::move(loop));
    }
    return out;
  }

  // Inserts the regions and returns true. With `in_turns`, it returns false and changes nothing when the
  // regions would not be sound.
  bool run(bool in_turns) {
    find_edges();
    find_regions(in_turns);
    nest_regions();
    if (in_turns && !is_sound()) return false;
    insert();
    return true;
  }

 private:
  DraftBlock& block(BlockId b) { return draft_.blocks[b]; }

  // Finds the edges that count. Edges to early ends are dropped where there is another way.
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

  // Gives every block a way to the virtual end: an exit gets an edge, and an endless loop gets one from one
  // of its blocks.
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

  // Returns which blocks have a way to `target`. With `counted`, only edges that count are followed.
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

  bool parts_lanes(BlockId b, const Edges& edges) const {
    const DraftBlock& x = draft_.blocks[b];
    return reachable_[b] && x.end == DraftBlock::End::Branch && !x.uniform && x.taken != x.next &&
           edges[b].size() == 2;
  }

  // Returns the edges within the loop, where an edge back to its head leads to the virtual end.
  Edges edges_of_turn(const Loop& loop) const {
    Edges turn(next_.size());
    for (BlockId b : loop.body)
      for (BlockId n : next_[b])
        if (loop.body.contains(n)) turn[b].push_back(n == loop.head ? end_ : n);
    return turn;
  }

  void find_regions(bool in_turns) {
    std::vector<bool> done(size_t{end_} + 1);
    const auto find = [&](const Edges& edges) {
      const std::vector<BlockId> post = immediate_dominators(reversed(edges), end_);
      for (BlockId b : draft_.layout) {
        if (done[b] || !parts_lanes(b, edges)) continue;
        done[b] = true;
        if (post[b] == end_) continue;
        Blocks& region = regions_[post[b]];
        std::vector<BlockId> work{b};
        while (!work.empty()) {
          const BlockId at = work.back();
          work.pop_back();
          if (at == post[b] || at == end_ || !region.insert(at).second) continue;
          work.insert(work.end(), edges[at].begin(), edges[at].end());
        }
      }
    };
    if (in_turns)
      for (const Loop& loop : natural_loops(next_, draft_.layout.front())) find(edges_of_turn(loop));
    find(next_);
  }

  // Returns whether any two regions are nested or disjoint, and whether lanes that leave a region by another
  // way than its meeting place come to a meeting place around it before they could come back.
  bool is_sound() {
    for (const auto& [p, s] : regions_) {
      if (s.contains(p)) return false;
      for (const auto& [other, t] : regions_)
        if (overlap(s, t) && !std::includes(s.begin(), s.end(), t.begin(), t.end()) &&
            !std::includes(t.begin(), t.end(), s.begin(), s.end()))
          return false;
      if (comes_back(p, s)) return false;
    }
    return true;
  }
  bool comes_back(BlockId meet, const Blocks& region) {
    std::set<BlockId> seen;
    std::vector<BlockId> work;
    const auto follow = [&](BlockId b) {
      for (BlockId n : block(b).successors()) {
        const auto around = regions_.find(n);
        const bool waits =
            around != regions_.end() && around->second.contains(b) &&
            std::includes(around->second.begin(), around->second.end(), region.begin(), region.end());
        if (!waits && !(region.contains(b) && region.contains(n))) work.push_back(n);
      }
    };
    for (BlockId b : region) follow(b);
    while (!work.empty()) {
      const BlockId b = work.back();
      work.pop_back();
      if (b == meet || region.contains(b)) return true;
      if (seen.insert(b).second) follow(b);
    }
    return false;
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

  // Returns the meeting places of the regions that an edge enters, outermost first. `from` is a block. With
  // `behind_join` the edge starts at the join of `to`, which lies in a region exactly when all of S(to) does.
  std::vector<BlockId> entered(BlockId from, BlockId to, bool behind_join) const {
    std::vector<BlockId> out;
    for (const auto& [p, s] : regions_) {
      if (!s.contains(to)) continue;
      const bool inside = behind_join ? overlap(s, regions_.at(to)) : s.contains(from);
      if (!inside) out.push_back(p);
    }
    std::sort(out.begin(), out.end(),
              [&](BlockId a, BlockId b) { return regions_.at(a).size() > regions_.at(b).size(); });
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

  // Leads the edges into block `to` through its join and the ssy instructions that they need. Regions that
  // all ways into the block enter last are pushed by the block itself, just before it ends.
  void connect(BlockId to, const std::vector<Edge>& edges) {
    const bool has_join = joins_.contains(to);
    std::vector<BlockId> behind_join = has_join ? entered(to, to, true) : std::vector<BlockId>{};
    std::vector<BlockId> shared = has_join ? behind_join : edges.front().enters;
    for (const Edge& edge : edges)
      if (!edge.to_join) keep_common_end(shared, edge.enters);
    at_end_[to] = shared;
    if (has_join) {
      behind_join.resize(behind_join.size() - shared.size());
      push_all(block(joins_[to]).code, behind_join, block(to).line);
    }
    for (Edge edge : edges) {
      if (!edge.to_join) edge.enters.resize(edge.enters.size() - shared.size());
      lead(edge, to);
    }
  }
  static void keep_common_end(std::vector<BlockId>& a, const std::vector<BlockId>& b) {
    size_t common = 0;
    while (common < std::min(a.size(), b.size()) && a[a.size() - 1 - common] == b[b.size() - 1 - common])
      ++common;
    a.erase(a.begin(), a.end() - std::ptrdiff_t(common));
  }
  void lead(const Edge& edge, BlockId to) {
    DraftBlock& from = block(edge.from);
    if (edge.to_join) {
      (edge.taken ? from.taken : from.next) = joins_[to];
    } else if (!edge.enters.empty() && from.end == DraftBlock::End::Goto) {
      on_edge_[edge.from] = edge.enters;
    } else if (!edge.enters.empty()) {
      const BlockId between = new_block("", to, from.line);
      push_all(block(between).code, edge.enters, block(edge.from).line);
      DraftBlock& again = block(edge.from);  // new_block() may have moved the block.
      (edge.taken ? again.taken : again.next) = between;
      behind_[edge.from].push_back(between);
    }
  }

  Draft& draft_;
  const BlockId end_;  // the virtual end
  Edges next_;         // the edges that count
  std::vector<bool> reachable_;
  std::map<BlockId, Blocks> regions_;                         // S(P) by P
  std::map<BlockId, BlockId> joins_;                          // join block of P
  std::map<BlockId, std::vector<BlockId>> at_end_, on_edge_;  // regions that a block pushes before it ends
  std::map<BlockId, std::vector<BlockId>> behind_;            // new blocks, by the block after which they lie
};

// Makes all branches back to the loop's head go to a new block, which goes to the head.
void end_turns(Draft& draft, const Loop& loop) {
  const auto turn_end = BlockId(draft.blocks.size());
  DraftBlock block;
  block.name = draft.blocks[loop.head].name.empty() ? "" : draft.blocks[loop.head].name + "_again";
  block.line = draft.blocks[loop.head].line;
  block.end = DraftBlock::End::Goto;
  block.next = loop.head;
  const auto in_layout = [&](BlockId b) { return std::find(draft.layout.begin(), draft.layout.end(), b); };
  auto last = draft.layout.begin();
  for (BlockId b : loop.body) {
    DraftBlock& from = draft.blocks[b];
    if (from.end != DraftBlock::End::Exit && from.next == loop.head) from.next = turn_end;
    if (from.end == DraftBlock::End::Branch && from.taken == loop.head) from.taken = turn_end;
    last = std::max(last, in_layout(b));
  }
  draft.layout.insert(last + 1, turn_end);
  draft.blocks.push_back(std::move(block));
}

}  // namespace

void add_reconvergence(Draft& draft) {
  Draft with_ends = draft;
  for (const Loop& loop : Reconvergence(draft).loops_without_end()) end_turns(with_ends, loop);
  if (Reconvergence(with_ends).run(true))
    draft = std::move(with_ends);
  else
    Reconvergence(draft).run(false);
}

}  // namespace glint::frontend::ptx
