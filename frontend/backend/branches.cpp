// Cleans up branches over encoded blocks.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/branches.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace glint::frontend {
namespace {

class BranchCleaner {
 public:
  BranchCleaner(Code& code, const Ops& ops) : code_(code), ops_(ops), next_(code.size()) { forget_runs(); }

  void run() {
    clean();
    if (!rotate_loops()) return;
    clean();
  }

 private:
  void clean() {
    for (bool changed = true; changed;) {
      thread();
      changed = drop_unreachable();
      for (size_t b = 0; b < code_.size(); ++b) changed |= tidy_end(b);
      changed |= merge_straight_lines();
      changed |= drop_lone_joins();
    }
  }

  static bool is_guarded(const Coded& c) { return c.inst.guard != isa::kNoGuard; }
  bool is_branch(const Coded& c) const { return c.inst.op == ops_.bra; }
  bool leaves(const Coded& c) const {
    const isa::Effect effect = isa::op_table()[c.inst.op].effect;
    return !is_guarded(c) && isa::ends_block(effect);
  }
  bool falls_through(size_t block) const { return code_[block].empty() || !leaves(code_[block].back()); }
  // Returns the first block from `block` on that has code. Runs of empty blocks are skipped at once the next
  // time.
  size_t first_code(size_t block) const {
    size_t end = block;
    while (end < code_.size() && code_[end].empty()) end = next_[end];
    while (block < end) block = std::exchange(next_[block], end);
    return end;
  }
  void forget_runs() {
    for (size_t b = 0; b < next_.size(); ++b) next_[b] = b + 1;
  }

  // Redirects a branch that leads to an unguarded branch to that branch's target. An endless ring of branches
  // stays as it is.
  void thread() {
    for (std::vector<Coded>& block : code_)
      for (Coded& c : block) {
        if (!is_branch(c)) continue;
        for (size_t hops = 0; hops < code_.size(); ++hops) {
          const size_t at = first_code(c.target);
          if (at == code_.size() || !is_branch(code_[at].front()) || is_guarded(code_[at].front())) break;
          c.target = code_[at].front().target;
        }
      }
  }

  bool drop_unreachable() {
    std::vector<bool> seen(code_.size());
    std::vector<size_t> work{0};
    bool changed = false;
    while (!work.empty()) {
      const size_t b = work.back();
      work.pop_back();
      if (b >= code_.size() || seen[b]) continue;
      seen[b] = true;
      std::vector<Coded>& block = code_[b];
      const auto last = std::find_if(block.begin(), block.end(), [&](const Coded& c) { return leaves(c); });
      if (last != block.end() && last + 1 != block.end()) {
        block.erase(last + 1, block.end());
        changed = true;
      }
      for (const Coded& c : block)
        if (c.target != kNoBlock) work.push_back(c.target);
      if (falls_through(b)) work.push_back(b + 1);
    }
    for (size_t b = 0; b < code_.size(); ++b) {
      if (seen[b] || code_[b].empty()) continue;
      code_[b].clear();
      changed = true;
    }
    return changed;
  }

  bool tidy_end(size_t b) {
    std::vector<Coded>& block = code_[b];
    const size_t next = first_code(b + 1);
    const auto goes_next = [&](const Coded& c) { return is_branch(c) && first_code(c.target) == next; };
    if (!block.empty() && goes_next(block.back())) {
      block.pop_back();
      return true;
    }
    if (block.size() < 2) return false;
    Coded& choice = block[block.size() - 2];
    if (!is_branch(choice) || !is_guarded(choice) || !is_branch(block.back()) || is_guarded(block.back()))
      return false;
    if (goes_next(choice)) {
      choice.inst.guard ^= isa::kGuardNegate;
      choice.target = block.back().target;
    } else if (first_code(choice.target) != first_code(block.back().target)) {
      return false;
    } else {
      // Both branches lead to the same place, so the guarded one is not needed. It goes to the end and is
      // removed.
      std::swap(choice, block.back());
    }
    block.pop_back();
    return true;
  }

  // Counts the branches that lead to each block and the ssy instructions that name it. Those of an empty
  // block count for the next block with code.
  struct Edges {
    uint32_t branches = 0, ssys = 0;
    size_t from = 0;  // block of the last branch
    void add(const Edges& more) {
      branches += more.branches, ssys += more.ssys;
      from = std::max(from, more.from);
    }
  };
  std::vector<Edges> count_edges() const {
    std::vector<Edges> edges(code_.size() + 1);
    for (size_t b = 0; b < code_.size(); ++b)
      for (const Coded& c : code_[b]) {
        if (c.target == kNoBlock) continue;
        Edges& to = edges[first_code(c.target)];
        if (!is_branch(c)) {
          ++to.ssys;
        } else {
          ++to.branches;
          to.from = b;
        }
      }
    return edges;
  }

  bool merge_straight_lines() {
    const std::vector<Edges> edges = count_edges();
    bool changed = false;
    size_t into = first_code(0);
    for (size_t b = first_code(into + 1); b < code_.size(); b = first_code(b + 1)) {
      if (edges[b].branches + edges[b].ssys == 0 && falls_through(into)) {
        code_[into].insert(code_[into].end(), code_[b].begin(), code_[b].end());
        code_[b].clear();
        changed = true;
      } else {
        into = b;
      }
    }
    return changed;
  }

  bool drop_lone_joins() {
    std::vector<Edges> edges = count_edges();
    bool changed = false;
    std::vector<size_t> before;  // the blocks with code up to here
    for (size_t b = first_code(0); b < code_.size(); before.push_back(b), b = first_code(b + 1)) {
      while (!before.empty() && code_[before.back()].empty()) before.pop_back();
      if (code_[b].front().inst.op != ops_.join || edges[b].ssys != 1) continue;
      const bool falls_in = !before.empty() && falls_through(before.back());
      if (edges[b].branches + falls_in != 1) continue;
      const size_t source = falls_in ? before.back() : edges[b].from;
      std::vector<Coded>& from = code_[source];
      const auto ssy = std::find_if(from.begin(), from.end(), [&](const Coded& c) {
        return c.inst.op == ops_.ssy && first_code(c.target) == b;
      });
      if (ssy == from.end()) continue;
      // If a region was opened after this ssy, the edge leaves that region, which would stay open without the
      // join.
      if (std::any_of(ssy + 1, from.end(), [&](const Coded& c) { return c.inst.op == ops_.ssy; })) continue;
      code_[b].erase(code_[b].begin());
      from.erase(ssy);
      --edges[b].ssys;
      changed = true;
      // The edges of a block that has become empty lead to the next one.
      for (size_t emptied : {std::max(source, b), std::min(source, b)})
        if (code_[emptied].empty()) edges[first_code(emptied)].add(std::exchange(edges[emptied], {}));
    }
    return changed;
  }

  // Rotates a loop that ends in `bra H`, where H is a few plain instructions and `@p bra out` that falls
  // through into the body. A copy of these instructions with `@!p bra body` replaces the branch.
  bool rotate_loops() {
    constexpr size_t kLongestTest = 5;  // instructions copied, with the branch
    bool changed = false;
    for (size_t b = 0; b < code_.size(); ++b) {
      std::vector<Coded>& block = code_[b];
      if (block.empty() || !is_branch(block.back()) || is_guarded(block.back())) continue;
      const size_t head = first_code(block.back().target);
      if (head > b || head == code_.size()) continue;
      const auto test =
          std::find_if(code_[head].begin(), code_[head].end(), [&](const Coded& c) { return is_branch(c); });
      const size_t length = size_t(test - code_[head].begin()) + 1;
      if (test == code_[head].end() || !is_guarded(*test) || length > kLongestTest) continue;
      if (first_code(test->target) <= head) continue;
      if (!std::all_of(code_[head].begin(), test, [&](const Coded& c) {
            return isa::op_table()[c.inst.op].effect == isa::Effect::None ||
                   isa::op_table()[c.inst.op].effect == isa::Effect::Load;
          }))
        continue;
      const BlockId body = split_behind(head, length);
      if (body == kNoBlock) continue;
      const std::vector<Coded> copied = code_[head];
      std::vector<Coded>& bottom = code_[b == head ? body : b];
      bottom.pop_back();
      bottom.insert(bottom.end(), copied.begin(), copied.end());
      Coded leave = bottom.back();
      leave.inst.guard = isa::kNoGuard;
      bottom.back().inst.guard ^= isa::kGuardNegate;
      bottom.back().target = body;
      bottom.push_back(leave);
      changed = true;
    }
    return changed;
  }

  // Splits a block after its first `length` instructions. The rest moves to the next block, which must be
  // free.
  BlockId split_behind(size_t block, size_t length) {
    if (length == code_[block].size()) {
      const size_t next = first_code(block + 1);
      return next == code_.size() ? kNoBlock : BlockId(next);
    }
    if (block + 1 >= code_.size() || !code_[block + 1].empty()) return kNoBlock;
    code_[block + 1].assign(code_[block].begin() + std::ptrdiff_t(length), code_[block].end());
    code_[block].resize(length);
    forget_runs();
    return BlockId(block + 1);
  }

  Code& code_;
  const Ops& ops_;
  mutable std::vector<size_t> next_;  // of an empty block: a later one, with only empty blocks between
};

}  // namespace

void clean_branches(Code& code, const Ops& ops) {
  BranchCleaner(code, ops).run();
}

}  // namespace glint::frontend
