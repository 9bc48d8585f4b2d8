// Builds the dependence graph of straight runs of movable instructions and schedules them by list scheduling.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/schedule.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "frontend/backend/liveness.h"
#include "frontend/backend/slow_paths.h"

namespace glint::frontend {
namespace {

uint32_t latency_of(const VirtualInst& inst) {
  return isa::scheduled_latency(row_of(inst).unit);
}

// Counts how much of the register files values take: 32-bit registers and predicates.
struct Pressure {
  int words = 0, predicates = 0;
  Pressure& operator+=(Pressure o) { return words += o.words, predicates += o.predicates, *this; }
  Pressure& operator-=(Pressure o) { return words -= o.words, predicates -= o.predicates, *this; }
  int sum() const { return words + predicates; }
};

Pressure pressure_of(RegisterClass c) {
  return {c == RegisterClass::B64   ? 2
          : c == RegisterClass::B32 ? 1
                                    : 0,
          c == RegisterClass::Predicate ? 1 : 0};
}
Pressure larger(Pressure a, Pressure b) {
  return {std::max(a.words, b.words), std::max(a.predicates, b.predicates)};
}
// Returns whether `growth` fits in addition to `now`. It always does where nothing grows.
bool fits(Pressure now, Pressure growth, Pressure limit) {
  return (growth.words <= 0 || now.words + growth.words <= limit.words) &&
         (growth.predicates <= 0 || now.predicates + growth.predicates <= limit.predicates);
}

// Describes a memory access for the search for dependences.
struct MemoryUse {
  bool any = false, writes = false, in_frame = false;
  isa::Space space = isa::Space::None;
  int64_t begin = 0, end = 0;  // byte range in the frame
};

MemoryUse memory_use(const VirtualInst& inst) {
  const isa::OpRow& row = row_of(inst);
  MemoryUse use;
  const isa::EffectRow& effect = isa::effect_row(row.effect);
  if (effect.family == isa::EffectFamily::Image) {
    // Choice: images and buffers may share memory, so texture and surface ops are ordered like global
    // accesses.
    use = {true, effect.writes_memory, false, isa::Space::Global, 0, 0};
  } else if (effect.family == isa::EffectFamily::Memory) {
    use = {true,     effect.writes_memory,
           false,    row.memory.space,
           inst.imm, int64_t{inst.imm} + row.memory.bytes * row.memory.count};
    for (const VirtualOperand& o : inst.operands)
      use.in_frame |= o.kind == VirtualOperand::Kind::StackPointer;
  }
  return use;
}

bool must_stay_in_order(const MemoryUse& a, const MemoryUse& b) {
  if (!a.any || !b.any || (!a.writes && !b.writes)) return false;
  // A generic address may lie in any space.
  const bool is_generic = a.space == isa::Space::Generic || b.space == isa::Space::Generic;
  if (a.space != b.space && !is_generic) return false;
  if (a.in_frame && b.in_frame) return a.begin < b.end && b.begin < a.end;
  return true;
}

bool reads_clock(const VirtualInst& inst) {
  return std::any_of(inst.operands.begin(), inst.operands.end(), [](const VirtualOperand& o) {
    return o.kind == VirtualOperand::Kind::Special && o.special == isa::Special::Clock;
  });
}

// Schedules one run of movable instructions.
class Run {
 public:
  // `behind` is the guard of the first guarded instruction after the run, or kNoRegister.
  Run(const VirtualProgram& program, std::vector<VirtualInst> code, RegisterSet live_out,
      uint32_t guard_latency, VirtualRegister behind)
      : program_(program),
        code_(std::move(code)),
        live_out_(std::move(live_out)),
        guard_latency_(guard_latency),
        nodes_(code_.size()) {
    LiveWalk walk(live_out_);
    for (size_t i = code_.size(); i-- > 0;) walk.step(code_[i]);
    live_in_ = walk.live();
    add_dependences();
    for (size_t i = code_.size(); i-- > 0;) {
      nodes_[i].height = latency_of(code_[i]);
      for_each_def(code_[i],
                   [&](VirtualRegister r) { nodes_[i].height += r == behind ? guard_latency_ : 0; });
      for (const Edge& edge : nodes_[i].after)
        nodes_[i].height = std::max(nodes_[i].height, edge.delay + nodes_[edge.to].height);
    }
  }

  // Returns the new order, or the old order when it needs fewer registers and the new one does not fit
  // `comfortable`.
  std::vector<VirtualInst> schedule(Pressure comfortable) {
    const Pressure old_peak = peak(code_);
    std::vector<VirtualInst> ordered = list_schedule(comfortable);
    const Pressure new_peak = peak(ordered);
    const bool is_worse =
        (new_peak.words > comfortable.words && new_peak.words > old_peak.words) ||
        (new_peak.predicates > comfortable.predicates && new_peak.predicates > old_peak.predicates);
    return is_worse ? std::move(code_) : std::move(ordered);
  }

 private:
  struct Edge {
    size_t to;
    uint32_t delay;  // cycles from issue to issue
  };
  struct Node {
    std::vector<Edge> after;
    uint32_t waits_for = 0, height = 0, earliest = 0;
  };
  struct LastAccess {
    std::vector<size_t> writers, readers;  // writers: the last unguarded write and the guarded ones since
  };

  void depend(size_t from, size_t to, uint32_t delay) {
    nodes_[from].after.push_back({to, delay});
    ++nodes_[to].waits_for;
  }

  void add_dependences() {
    std::vector<std::pair<VirtualRegister, LastAccess>> accesses;  // sorted by register
    const auto access = [&](VirtualRegister r) -> LastAccess& {
      const auto at = std::lower_bound(accesses.begin(), accesses.end(), r,
                                       [](const auto& a, VirtualRegister b) { return a.first < b; });
      if (at != accesses.end() && at->first == r) return at->second;
      return accesses.insert(at, {r, {}})->second;
    };
    std::vector<std::pair<size_t, MemoryUse>> memory;
    for (size_t i = 0; i < code_.size(); ++i) {
      for_each_use(code_[i], [&](VirtualRegister r) {
        LastAccess& last = access(r);
        for (size_t w : last.writers)
          depend(w, i, latency_of(code_[w]) + (r == code_[i].guard ? guard_latency_ : 0));
        last.readers.push_back(i);
      });
      for_each_def(code_[i], [&](VirtualRegister r) {
        LastAccess& last = access(r);
        for (size_t reader : last.readers)
          if (reader != i) depend(reader, i, 1);
        for (size_t w : last.writers)
          if (w != i) depend(w, i, 1);
        if (!is_guarded(code_[i])) last.writers.clear();
        last.readers.clear();
        last.writers.push_back(i);
      });
      const MemoryUse use = memory_use(code_[i]);
      if (!use.any) continue;
      for (const auto& [earlier, other] : memory)
        if (must_stay_in_order(other, use))
          depend(earlier, i, other.writes && !use.writes ? latency_of(code_[earlier]) : 1);
      memory.emplace_back(i, use);
    }
  }

  // Returns the largest number of registers that are live at once.
  Pressure peak(const std::vector<VirtualInst>& code) const {
    RegisterSet live = live_out_;
    Pressure now = count(live), most = now;
    for (size_t i = code.size(); i-- > 0;) {
      Pressure with_dead_results = now;
      for_each_def(code[i], [&](VirtualRegister r) {
        with_dead_results += live.contains(r) ? Pressure{} : pressure(r);
      });
      most = larger(most, with_dead_results);
      if (!is_guarded(code[i]))
        for_each_def(code[i], [&](VirtualRegister r) {
          if (!live.contains(r)) return;
          live.erase(r);
          now -= pressure(r);
        });
      for_each_use(code[i], [&](VirtualRegister r) {
        if (live.contains(r)) return;
        live.insert(r);
        now += pressure(r);
      });
      most = larger(most, now);
    }
    return most;
  }

  Pressure pressure(VirtualRegister r) const { return pressure_of(program_.registers[r]); }

  Pressure count(const RegisterSet& live) const {
    Pressure all;
    live.for_each([&](VirtualRegister r) { all += pressure(r); });
    return all;
  }

  // Returns the growth of the pressure when instruction `i` issues next: what becomes live minus what dies.
  Pressure growth(size_t i, const RegisterSet& live,
                  const std::vector<std::pair<VirtualRegister, uint32_t>>& uses_left) const {
    Pressure more;
    for_each_def(code_[i], [&](VirtualRegister r) {
      if (!live.contains(r)) more += pressure(r);
    });
    std::vector<VirtualRegister> counted;
    for_each_use(code_[i], [&](VirtualRegister r) {
      if (std::find(counted.begin(), counted.end(), r) != counted.end()) return;
      counted.push_back(r);
      if (live.contains(r) && !live_out_.contains(r) && uses_of(uses_left, r) == 1) more -= pressure(r);
    });
    return more;
  }

  // Returns growth(), which is computed again only after forget_growth().
  Pressure known_growth(size_t i, const RegisterSet& live,
                        const std::vector<std::pair<VirtualRegister, uint32_t>>& uses_left) {
    if (!growth_[i]) growth_[i] = growth(i, live, uses_left);
    return *growth_[i];
  }
  void forget_growth(VirtualRegister r) {
    const auto begin =
        std::lower_bound(register_users_.begin(), register_users_.end(), std::pair(r, size_t{0}));
    for (auto at = begin; at != register_users_.end() && at->first == r; ++at) growth_[at->second].reset();
  }
  void index_registers() {
    growth_.assign(code_.size(), std::nullopt);
    for (size_t i = 0; i < code_.size(); ++i) {
      const auto add = [&](VirtualRegister r) { register_users_.emplace_back(r, i); };
      for_each_def(code_[i], add);
      for_each_use(code_[i], add);
    }
    std::sort(register_users_.begin(), register_users_.end());
  }

  // Returns how many instructions still to come read `r`.
  static uint32_t uses_of(const std::vector<std::pair<VirtualRegister, uint32_t>>& uses, VirtualRegister r) {
    const auto at = std::lower_bound(uses.begin(), uses.end(), r,
                                     [](const auto& a, VirtualRegister b) { return a.first < b; });
    return at != uses.end() && at->first == r ? at->second : 0;
  }

  template <class Visit>
  static void for_each_distinct_use(const VirtualInst& inst, Visit&& visit) {
    std::vector<VirtualRegister> seen;
    for_each_use(inst, [&](VirtualRegister r) {
      if (std::find(seen.begin(), seen.end(), r) != seen.end()) return;
      seen.push_back(r);
      visit(r);
    });
  }

  std::vector<std::pair<VirtualRegister, uint32_t>> count_uses() const {
    std::vector<VirtualRegister> all;
    for (const VirtualInst& inst : code_)
      for_each_distinct_use(inst, [&](VirtualRegister r) { all.push_back(r); });
    std::sort(all.begin(), all.end());
    std::vector<std::pair<VirtualRegister, uint32_t>> uses;
    for (VirtualRegister r : all) {
      if (uses.empty() || uses.back().first != r) uses.emplace_back(r, 0);
      ++uses.back().second;
    }
    return uses;
  }

  std::vector<VirtualInst> list_schedule(Pressure comfortable) {
    std::vector<std::pair<VirtualRegister, uint32_t>> uses_left = count_uses();
    index_registers();
    RegisterSet live = live_in_;
    Pressure now = count(live);
    std::vector<size_t> ready;
    for (size_t i = 0; i < nodes_.size(); ++i)
      if (nodes_[i].waits_for == 0) ready.push_back(i);
    std::vector<VirtualInst> out;
    for (uint32_t cycle = 0; !ready.empty(); ++cycle) {
      size_t best = 0;
      Pressure best_growth = known_growth(ready[0], live, uses_left);
      for (size_t k = 1; k < ready.size(); ++k) {
        const Pressure candidate = known_growth(ready[k], live, uses_left);
        if (!is_better(ready[k], candidate, ready[best], best_growth, cycle, now, comfortable)) continue;
        best = k;
        best_growth = candidate;
      }
      const size_t chosen = ready[best];
      ready.erase(ready.begin() + std::ptrdiff_t(best));
      cycle = std::max(cycle, nodes_[chosen].earliest);
      now += best_growth;
      issue(chosen, cycle, live, uses_left, ready);
      out.push_back(code_[chosen]);
    }
    return out;
  }

  bool is_better(size_t a, Pressure a_growth, size_t b, Pressure b_growth, uint32_t cycle, Pressure now,
                 Pressure comfortable) const {
    const bool a_fits = fits(now, a_growth, comfortable), b_fits = fits(now, b_growth, comfortable);
    if (a_fits != b_fits) return a_fits;
    // Without room, the instruction that frees most comes first, and ties keep the old order.
    if (!a_fits || now.words >= comfortable.words) {
      if (a_growth.sum() != b_growth.sum()) return a_growth.sum() < b_growth.sum();
      return a < b;
    }
    const uint32_t a_start = std::max(nodes_[a].earliest, cycle),
                   b_start = std::max(nodes_[b].earliest, cycle);
    if (a_start != b_start) return a_start < b_start;
    if (nodes_[a].height != nodes_[b].height) return nodes_[a].height > nodes_[b].height;
    if (a_growth.words != b_growth.words) return a_growth.words < b_growth.words;
    return a < b;
  }

  void issue(size_t chosen, uint32_t cycle, RegisterSet& live,
             std::vector<std::pair<VirtualRegister, uint32_t>>& uses_left, std::vector<size_t>& ready) {
    for_each_distinct_use(code_[chosen], [&](VirtualRegister r) {
      const auto at = std::lower_bound(uses_left.begin(), uses_left.end(), r,
                                       [](const auto& a, VirtualRegister b) { return a.first < b; });
      if (--at->second == 0 && !live_out_.contains(r)) live.erase(r);
      if (at->second <= 1) forget_growth(r);
    });
    for_each_def(code_[chosen], [&](VirtualRegister r) {
      if (!live.contains(r)) forget_growth(r);
      live.insert(r);
    });
    for (const Edge& edge : nodes_[chosen].after) {
      Node& next = nodes_[edge.to];
      next.earliest = std::max(next.earliest, cycle + edge.delay);
      if (--next.waits_for == 0) ready.push_back(edge.to);
    }
  }

  const VirtualProgram& program_;
  std::vector<VirtualInst> code_;
  RegisterSet live_in_, live_out_;
  const uint32_t guard_latency_;
  std::vector<Node> nodes_;
  std::vector<std::pair<VirtualRegister, size_t>> register_users_;  // sorted: what reads or writes a register
  std::vector<std::optional<Pressure>> growth_;                     // by instruction; empty: to be computed
};

}  // namespace

void schedule(VirtualProgram& program, uint32_t max_registers, uint32_t guard_latency,
              bool slow_paths_end_runs) {
  // Register allocation needs this room in addition to the live words: the stack pointer, gaps between pairs,
  // and the registers of spill code.
  constexpr uint32_t kReserve = 4;
  constexpr size_t kShortestRun = 3, kLongestRun = 2000;  // Longer runs are cut: the search is quadratic.
  const uint32_t words = max_registers > 2 * kReserve ? max_registers - kReserve : max_registers / 2;
  // One predicate is kept free for spill code, too.
  const Pressure comfortable{int(std::max(words, 1u)), isa::kNumPredicates - 1};
  const Liveness liveness = find_liveness(program);
  const std::vector<bool> enters_inside = enters_in_region(program);
  for (BlockId b = 0; b < program.blocks.size(); ++b) {
    std::vector<VirtualInst>& code = program.blocks[b].code;
    std::vector<bool> moves(code.size());
    bool inside = enters_inside[b];
    for (size_t i = 0; i < code.size(); ++i) {
      if (code[i].kind == VirtualInst::Kind::SaveLive) inside = true;
      if (code[i].kind == VirtualInst::Kind::RestoreLive) inside = false;
      moves[i] = !inside && is_movable(code[i]) && !reads_clock(code[i]) &&
                 !(slow_paths_end_runs && has_slow_path(code[i].op));
    }
    LiveWalk walk(liveness.out[b]);
    VirtualRegister guard = kNoRegister;  // guard of the first guarded instruction after the run
    for (size_t end = code.size(); end > 0;) {
      if (!moves[end - 1]) {
        walk.step(code[--end]);
        if (is_guarded(code[end])) guard = code[end].guard;
        continue;
      }
      size_t begin = end;
      while (begin > 0 && moves[begin - 1] && end - begin < kLongestRun) --begin;
      if (end - begin >= kShortestRun) {
        const auto first = code.begin() + std::ptrdiff_t(begin), last = code.begin() + std::ptrdiff_t(end);
        const std::vector<VirtualInst> ordered =
            Run(program, {first, last}, walk.live(), guard_latency, guard).schedule(comfortable);
        std::copy(ordered.begin(), ordered.end(), first);
      }
      while (end > begin) walk.step(code[--end]);
    }
  }
}

}  // namespace glint::frontend
