// Builds the dependence graph of straight runs of movable instructions and schedules them by list scheduling.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/schedule.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "frontend/backend/dependences.h"
#include "frontend/backend/liveness.h"
#include "frontend/backend/memory_use.h"
#include "frontend/backend/pressure.h"
#include "frontend/backend/slow_paths.h"
#include "frontend/backend/uniform.h"
#include "frontend/backend/use_counts.h"
#include "frontend/backend/value_names.h"

namespace glint::frontend {
namespace {

// Returns the latency of the unit, unless the machine's assembler is the model. Then an approximation with
// the scaling of subnormal operands around it has that of core/op_times/hopper.cpp, and a load from global
// memory that of a hit in the L2. Source: where registers allow it, the listings of an H200's assembler have
// all such loads of a run before the first use (nine in n_median, 26 in n_bilateral of bench/unseen).
uint32_t latency_of(const VirtualInst& inst, bool is_assembler) {
  constexpr uint32_t kGlobalLoad = 281;
  constexpr uint32_t kScaled = 40;
  constexpr std::string_view kNames[] = {"rcp.approx.f32", "rsqrt.approx.f32", "sqrt.approx.f32",
                                         "lg2.approx.f32"};
  const isa::OpRow& row = row_of(inst);
  if (is_assembler && row.memory.space == isa::Space::Global && memory_use(inst).is_load())
    return kGlobalLoad;
  if (is_assembler && row.unit == isa::Unit::Sfu &&
      std::find(std::begin(kNames), std::end(kNames), row.name) != std::end(kNames))
    return kScaled;
  return isa::scheduled_latency(row.unit);
}

bool reads_clock(const VirtualInst& inst) {
  return std::any_of(inst.operands.begin(), inst.operands.end(), [](const VirtualOperand& o) {
    return o.kind == VirtualOperand::Kind::Special && o.special == isa::Special::Clock;
  });
}

// Schedules one run of movable instructions.
class Run {
 public:
  // `behind` is the guard of the first guarded instruction after the run, or kNoRegister. With `free`, loads
  // keep their order (keep_loads_in_order()), and registers that it names take no room.
  Run(const VirtualProgram& program, std::vector<VirtualInst> code, RegisterSet live_out,
      uint32_t guard_latency, VirtualRegister behind, const std::vector<bool>* free)
      : program_(program),
        code_(std::move(code)),
        live_out_(std::move(live_out)),
        guard_latency_(guard_latency),
        free_(free),
        nodes_(code_.size()) {
    LiveWalk walk(live_out_);
    for (size_t i = code_.size(); i-- > 0;) walk.step(code_[i]);
    live_in_ = walk.live();
    for (const VirtualInst& inst : code_) is_load_.push_back(memory_use(inst).is_load());
    add_dependences();
    if (free_) keep_loads_in_order();
    name_values();
    for (size_t i = code_.size(); i-- > 0;) {
      nodes_[i].height = latency(code_[i]);
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
    std::vector<VirtualInst> ordered = list_schedule(comfortable, comfortable);
    const Pressure new_peak = peak(ordered);
    const bool is_worse =
        (new_peak.words > comfortable.words && new_peak.words > old_peak.words) ||
        (new_peak.predicates > comfortable.predicates && new_peak.predicates > old_peak.predicates);
    return is_worse ? std::move(code_) : std::move(ordered);
  }

  // Returns an order within `few`, or else one within the least limit up to `most` that does not make the run
  // several times as long as all the registers would. Choice: that is four times, in steps of four registers.
  // With these the orders of loads in bench/probes/tiles.csv come nearest to the assembler's.
  std::optional<std::vector<VirtualInst>> shortest_within_fewest(Pressure few, Pressure most) {
    constexpr uint32_t kLongest = 4, kStep = 4;
    if (auto order = shortest_within(few)) return std::move(order->code);
    const std::optional<Order> shortest = shortest_within(most);
    if (!shortest) return std::nullopt;
    const int live = std::max(count(live_in_).words, count(live_out_).words);
    for (Pressure limit = few; limit.words < most.words; limit.words += int(kStep)) {
      if (limit.words < live) continue;
      for (const bool holds_back : {false, true}) {
        holds_back_ = holds_back;
        auto order = shortest_within(limit);
        if (order && order->length <= kLongest * shortest->length) return std::move(order->code);
      }
    }
    return shortest->code;
  }

 private:
  struct Order {
    std::vector<VirtualInst> code;
    uint32_t length = 0;  // cycles
  };

  // Returns the shortest order that stays within `limit`, if one is found. The search is over the room that
  // loads may take: those that are issued too early leave none for the work on what was loaded.
  std::optional<Order> shortest_within(Pressure limit) {
    constexpr int kTries = 29;
    std::optional<Order> best;
    const bool has_loads = std::find(is_load_.begin(), is_load_.end(), true) != is_load_.end();
    const int least = has_loads || holds_back_ ? count(live_in_).words : limit.words - 1;
    for (int room = limit.words; room > least; room -= (limit.words + kTries - 1) / kTries) {
      std::vector<VirtualInst> ordered = list_schedule(limit, {room, limit.predicates});
      if ((best && length_ >= best->length) || !fits({}, peak(ordered), limit)) continue;
      best = {std::move(ordered), length_};
    }
    return best;
  }

  struct Edge {
    size_t to;
    uint32_t delay;  // cycles from issue to issue
  };
  struct Node {
    std::vector<Edge> after;
    uint32_t waits_for = 0, waits_now = 0, height = 0, earliest = 0;
  };
  void depend(size_t from, size_t to, uint32_t delay) {
    nodes_[from].after.push_back({to, delay});
    ++nodes_[to].waits_for;
  }

  void add_dependences() {
    const auto latency = [this](const VirtualInst& inst) { return this->latency(inst); };
    for (const auto& [from, to, delay] : find_dependences(code_, latency, guard_latency_))
      depend(from, to, delay);
  }

  // Model: loads keep their order, as in the listings of an H200's assembler. A load may only overtake one
  // whose address waits for more loads than its own. In any other order, loads whose addresses are ready take
  // the room of those that are used first.
  void keep_loads_in_order() {
    // loads on the longest way to the instruction, itself left out; and the last load of each such number
    std::vector<size_t> level(code_.size()), last;
    for (size_t i = 0; i < code_.size(); ++i) {
      for (const Edge& edge : nodes_[i].after)
        level[edge.to] = std::max(level[edge.to], level[i] + (is_load_[i] && edge.delay > 1 ? 1 : 0));
      if (!is_load_[i]) continue;
      last.resize(std::max(last.size(), level[i] + 1), code_.size());
      for (size_t l = 0; l <= level[i]; ++l)
        if (last[l] < code_.size()) depend(last[l], i, 1);
      last[level[i]] = i;
    }
  }

  // Names values where loads keep their order. Choice: otherwise a register counts as live from its first
  // value to its last, which the presets without that order were tuned with.
  void name_values() {
    scheduled_in_ = live_in_, scheduled_out_ = live_out_;
    if (!free_) return;
    names_.emplace(code_, program_.registers.size());
    RegisterSet in(names_->size()), out(names_->size());
    live_in_.for_each([&](VirtualRegister r) { in.insert(r); });
    live_out_.for_each([&](VirtualRegister r) { out.insert(names_->last(r)); });
    scheduled_in_ = std::move(in), scheduled_out_ = std::move(out);
  }
  const std::vector<VirtualInst>& named_code() const { return names_ ? names_->code() : code_; }

  uint32_t latency(const VirtualInst& inst) const { return latency_of(inst, free_ != nullptr); }

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

  Pressure pressure(VirtualRegister name) const {
    const VirtualRegister r = names_ ? names_->register_of(name) : name;
    return free_ && (*free_)[r] ? Pressure{} : pressure_of(program_.registers[r]);
  }

  Pressure count(const RegisterSet& live) const {
    Pressure all;
    live.for_each([&](VirtualRegister r) { all += pressure(r); });
    return all;
  }

  // Returns the growth of the pressure when instruction `i` issues next: what becomes live minus what dies.
  Pressure growth(size_t i, const RegisterSet& live,
                  const std::vector<std::pair<VirtualRegister, uint32_t>>& uses_left) const {
    Pressure more;
    for_each_def(named_code()[i], [&](VirtualRegister r) {
      if (!live.contains(r)) more += pressure(r);
    });
    std::vector<VirtualRegister> counted;
    for_each_use(named_code()[i], [&](VirtualRegister r) {
      if (std::find(counted.begin(), counted.end(), r) != counted.end()) return;
      counted.push_back(r);
      if (live.contains(r) && !scheduled_out_.contains(r) && uses_of(uses_left, r) == 1) more -= pressure(r);
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
    if (!register_users_.empty()) return;
    for (size_t i = 0; i < code_.size(); ++i) {
      const auto add = [&](VirtualRegister r) { register_users_.emplace_back(r, i); };
      for_each_def(named_code()[i], add);
      for_each_use(named_code()[i], add);
    }
    std::sort(register_users_.begin(), register_users_.end());
  }

  // Loads fit while no more than `for_loads` is taken.
  std::vector<VirtualInst> list_schedule(Pressure comfortable, Pressure for_loads) {
    std::vector<std::pair<VirtualRegister, uint32_t>> uses_left = count_uses(named_code());
    index_registers();
    growth_.assign(code_.size(), std::nullopt);
    RegisterSet live = scheduled_in_;
    Pressure now = count(live);
    std::vector<size_t> ready;
    length_ = 0;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      nodes_[i].earliest = 0;
      nodes_[i].waits_now = nodes_[i].waits_for;
      if (nodes_[i].waits_for == 0) ready.push_back(i);
    }
    std::vector<VirtualInst> out;
    for (uint32_t cycle = 0; !ready.empty(); ++cycle) {
      size_t best = 0;
      Pressure best_growth = known_growth(ready[0], live, uses_left);
      for (size_t k = 1; k < ready.size(); ++k) {
        const Pressure candidate = known_growth(ready[k], live, uses_left);
        if (!is_better(ready[k], candidate, ready[best], best_growth, cycle, now, comfortable, for_loads))
          continue;
        best = k;
        best_growth = candidate;
      }
      const size_t chosen = ready[best];
      ready.erase(ready.begin() + std::ptrdiff_t(best));
      cycle = std::max(cycle, nodes_[chosen].earliest);
      length_ = std::max(length_, cycle + latency(code_[chosen]));
      now += best_growth;
      issue(chosen, cycle, live, uses_left, ready);
      out.push_back(code_[chosen]);
    }
    return out;
  }

  bool is_better(size_t a, Pressure a_growth, size_t b, Pressure b_growth, uint32_t cycle, Pressure now,
                 Pressure comfortable, Pressure for_loads) const {
    const auto room_for = [&](size_t i, Pressure growth) {
      return is_load_[i] || (holds_back_ && growth.words > 0) ? for_loads : comfortable;
    };
    const bool a_fits = fits(now, a_growth, room_for(a, a_growth)),
               b_fits = fits(now, b_growth, room_for(b, b_growth));
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
    for_each_distinct_use(named_code()[chosen], [&](VirtualRegister r) {
      const auto at = std::lower_bound(uses_left.begin(), uses_left.end(), r,
                                       [](const auto& a, VirtualRegister b) { return a.first < b; });
      if (--at->second == 0 && !scheduled_out_.contains(r)) live.erase(r);
      if (at->second <= 1) forget_growth(r);
    });
    for_each_def(named_code()[chosen], [&](VirtualRegister r) {
      if (!live.contains(r)) forget_growth(r);
      live.insert(r);
    });
    for (const Edge& edge : nodes_[chosen].after) {
      Node& next = nodes_[edge.to];
      next.earliest = std::max(next.earliest, cycle + edge.delay);
      if (--next.waits_now == 0) ready.push_back(edge.to);
    }
  }

  const VirtualProgram& program_;
  std::vector<VirtualInst> code_;
  RegisterSet live_in_, live_out_;
  const uint32_t guard_latency_;
  const std::vector<bool>* free_;  // by register; null: all registers take room
  std::vector<bool> is_load_;      // by instruction
  bool holds_back_ = false;        // Everything that takes more room than it frees has the room of loads.
  std::optional<ValueNames> names_;
  RegisterSet scheduled_in_, scheduled_out_;  // live_in_ and live_out_, by names where there are some
  std::vector<Node> nodes_;
  uint32_t length_ = 0;                                             // cycles of the order found last
  std::vector<std::pair<VirtualRegister, size_t>> register_users_;  // sorted: what reads or writes a register
  std::vector<std::optional<Pressure>> growth_;                     // by instruction; empty: to be computed
};

}  // namespace

void schedule(VirtualProgram& program, uint32_t max_registers, uint32_t guard_latency,
              bool like_an_assembler) {
  // Register allocation needs this room in addition to the live words: the stack pointer, gaps between pairs,
  // and the registers of spill code.
  constexpr uint32_t kReserve = 4;
  // Model: an H200's assembler stays within 32 registers a thread wherever it can, in 80 kernels of bench: 30
  // of its own, of which one is the stack pointer. Where a run needs more, it takes what it needs.
  constexpr uint32_t kFewRegisters = 29;
  constexpr size_t kShortestRun = 3, kLongestRun = 2000;  // Longer runs are cut: the search is quadratic.
  const uint32_t words = max_registers > 2 * kReserve ? max_registers - kReserve : max_registers / 2;
  // One predicate is kept free for spill code, too.
  const Pressure comfortable{int(std::max(words, 1u)), isa::kNumPredicates - 1};
  const Pressure few{int(std::min(kFewRegisters, words)), comfortable.predicates};
  const std::vector<bool> uniform = like_an_assembler ? find_uniform(program) : std::vector<bool>();
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
                 !(like_an_assembler && has_slow_path(code[i].op));
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
        const auto run = [&](const std::vector<bool>* free) {
          return Run(program, {first, last}, walk.live(), guard_latency, guard, free);
        };
        std::optional<std::vector<VirtualInst>> ordered;
        if (like_an_assembler) ordered = run(&uniform).shortest_within_fewest(few, comfortable);
        if (!ordered) ordered = run(nullptr).schedule(comfortable);
        std::copy(ordered->begin(), ordered->end(), first);
      }
      while (end > begin) walk.step(code[--end]);
    }
  }
}

}  // namespace glint::frontend
