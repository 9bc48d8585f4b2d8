// Colours registers by Chaitin and Briggs with optimistic selection, for a file of single registers and
// aligned pairs. (G. Chaitin, "Register allocation and spilling via graph coloring", 1982; P. Briggs, K.
// Cooper, L. Torczon, "Improvements to graph coloring register allocation", 1994.)
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/allocate.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <fmt/format.h>

#include "base/check.h"
#include "base/diagnostics.h"
#include "frontend/backend/interference.h"
#include "frontend/backend/relief.h"
#include "frontend/backend/spill.h"
#include "frontend/backend/spill_costs.h"

namespace glint::frontend {
namespace {

constexpr uint16_t kNoSlot = 0xffff;

// Makes one attempt to colour one register file.
class Colouring {
 public:
  Colouring(const InterferenceGraph& graph, const std::vector<RegisterClass>& classes,
            const SpillCosts& costs, uint32_t max_registers)
      : graph_(graph),
        classes_(classes),
        costs_(costs),
        max_registers_(max_registers),
        slot_(classes.size(), kNoSlot),
        degree_(classes.size()),
        state_(classes.size(), State::Waiting) {}

  // Returns true when every value has a slot. Otherwise spilled() says what to spill; when it is empty, there
  // is no solution.
  bool run() {
    for (VirtualRegister r : graph_.nodes())
      if (costs_.of(r) < 0) spilled_.push_back(r);
    if (!spilled_.empty()) return false;
    simplify();
    while (!stack_.empty()) {
      const VirtualRegister r = stack_.back();
      stack_.pop_back();
      state_[r] = State::Waiting;
      slot_[r] = choose(r);
      if (slot_[r] == kNoSlot) give_up_on(r);
    }
    return spilled_.empty() && !stuck_;
  }
  const std::vector<VirtualRegister>& spilled() const { return spilled_; }
  uint16_t slot(VirtualRegister representative) const { return slot_[representative]; }

 private:
  enum class State : uint8_t { Waiting, Ready, Stacked };
  using Taken = std::bitset<isa::kMaxRegisters + 1>;

  template <class Visit>
  void for_each_neighbour(VirtualRegister r, Visit&& visit) const {
    for (VirtualRegister n : graph_.neighbours(r))
      if (graph_.representative(n) == n) visit(n);
  }
  bool surely_fits(VirtualRegister r) const { return degree_[r] < slots_for(classes_[r], max_registers_); }

  // Pushes the values on a stack, in an order in which the neighbours below a value leave it a slot, if
  // possible.
  void simplify() {
    std::vector<VirtualRegister> ready;
    for (VirtualRegister r : graph_.nodes()) {
      for_each_neighbour(r, [&](VirtualRegister n) { degree_[r] += blocked_by(classes_[r], classes_[n]); });
      if (!surely_fits(r)) {
        waiting_.push_back(r);
        continue;
      }
      state_[r] = State::Ready;
      ready.push_back(r);
    }
    std::reverse(ready.begin(), ready.end());
    for (size_t left = graph_.nodes().size(); left > 0; --left) {
      VirtualRegister r = kNoRegister;
      if (ready.empty()) {
        r = cheapest_waiting();
      } else {
        r = ready.back();
        ready.pop_back();
      }
      state_[r] = State::Stacked;
      stack_.push_back(r);
      for_each_neighbour(r, [&](VirtualRegister n) {
        if (state_[n] == State::Stacked) return;
        degree_[n] -= blocked_by(classes_[n], classes_[r]);
        if (state_[n] == State::Ready || !surely_fits(n)) return;
        state_[n] = State::Ready;
        ready.push_back(n);
      });
    }
  }

  // Returns the best candidate to spill. Values that must not spill come last. Single registers come before
  // pairs, so that pairs are coloured first.
  VirtualRegister cheapest_waiting() {
    std::erase_if(waiting_, [&](VirtualRegister r) { return state_[r] != State::Waiting; });
    VirtualRegister best = kNoRegister;
    float best_cost = 0;
    for (VirtualRegister r : waiting_) {
      const float cost = costs_.of(r) / float(degree_[r] + 1);
      const bool tie_by_size = best != kNoRegister && cost == best_cost &&
                               classes_[r] == RegisterClass::B32 && classes_[best] == RegisterClass::B64;
      if (best != kNoRegister && cost >= best_cost && !tie_by_size) continue;
      best = r;
      best_cost = cost;
    }
    return best;
  }

  Taken taken_around(VirtualRegister r) const {
    Taken taken;
    for_each_neighbour(r, [&](VirtualRegister n) {
      if (slot_[n] == kNoSlot) return;
      taken.set(slot_[n]);
      if (classes_[n] == RegisterClass::B64) taken.set(slot_[n] + 1u);
    });
    return taken;
  }

  bool is_free(const Taken& taken, RegisterClass c, int slot) const {
    if (slot < 0) return false;
    if (c == RegisterClass::Predicate) return slot < isa::kNumPredicates && !taken[size_t(slot)];
    if (c == RegisterClass::B32) return slot >= 1 && slot < int(max_registers_) && !taken[size_t(slot)];
    return slot >= 2 && slot % 2 == 0 && slot + 1 < int(max_registers_) && !taken[size_t(slot)] &&
           !taken[size_t(slot) + 1];
  }

  uint16_t choose(VirtualRegister r) {
    const Taken taken = taken_around(r);
    const RegisterClass c = classes_[r];
    uint16_t best = wished(r, taken);
    for (int slot = 0; best == kNoSlot && slot < int(max_registers_) && slot <= isa::kMaxRegisters; ++slot)
      if (is_free(taken, c, slot)) best = uint16_t(slot);
    if (best == kNoSlot) return best;
    // A single register goes next to a used one and not into an unused pair.
    if (c == RegisterClass::B32 && best != 1 && best % 2 == 0 && !taken[best + 1u] && wished_nothing_)
      for (int slot = best + 1; slot <= highest_; ++slot)
        if (is_free(taken, c, slot) && taken[size_t(slot ^ 1)]) {
          best = uint16_t(slot);
          break;
        }
    highest_ = std::max(highest_, int(best) + (c == RegisterClass::B64));
    return best;
  }

  // Returns the free slot whose wishes have the largest total weight.
  uint16_t wished(VirtualRegister r, const Taken& taken) {
    std::array<float, isa::kMaxRegisters + 1> votes{};
    uint16_t best = kNoSlot;
    for (const SlotWish& wish : graph_.wishes(r)) {
      const uint16_t other = slot_[graph_.representative(wish.other)];
      if (other == kNoSlot || graph_.representative(wish.other) == r) continue;
      const int slot = int(other) + wish.offset;
      if (!is_free(taken, classes_[r], slot)) continue;
      votes[size_t(slot)] += wish.weight;
      if (best == kNoSlot || votes[size_t(slot)] > votes[best]) best = uint16_t(slot);
    }
    wished_nothing_ = best == kNoSlot;
    return best;
  }

  // Handles a value without a free slot: it is spilled or, when it must not be, the cheapest neighbour that
  // blocks it is.
  void give_up_on(VirtualRegister r) {
    if (costs_.of(r) != kNeverSpill) {
      spilled_.push_back(r);
      return;
    }
    VirtualRegister victim = kNoRegister;
    for_each_neighbour(r, [&](VirtualRegister n) {
      if (slot_[n] == kNoSlot || costs_.of(n) == kNeverSpill) return;
      if (victim == kNoRegister || costs_.of(n) < costs_.of(victim)) victim = n;
    });
    if (victim == kNoRegister)
      stuck_ = true;
    else if (std::find(spilled_.begin(), spilled_.end(), victim) == spilled_.end())
      spilled_.push_back(victim);
  }

  const InterferenceGraph& graph_;
  const std::vector<RegisterClass>& classes_;
  const SpillCosts& costs_;
  const uint32_t max_registers_;
  std::vector<uint16_t> slot_;
  std::vector<uint32_t> degree_;
  std::vector<State> state_;
  std::vector<VirtualRegister> stack_, spilled_, waiting_;
  int highest_ = 0;
  bool wished_nothing_ = true, stuck_ = false;
};

// Colours one file, or changes the program so that the next attempt is easier. Returns true when the file is
// coloured.
bool colour_file(VirtualProgram& program, RegisterFile file, uint32_t max_registers, const Ops& ops,
                 std::vector<bool>& unspillable, Allocation& out) {
  const Liveness liveness = find_liveness(program);
  const std::vector<float> weights = block_weights(program);
  for (Coalescing how : {Coalescing::All, Coalescing::Safe}) {
    InterferenceGraph graph(program, liveness, ops, file, weights);
    graph.coalesce(how, max_registers, unspillable);
    SpillCosts costs(program, liveness, weights);
    costs.merge(graph, unspillable);
    Colouring colouring(graph, program.registers, costs, max_registers);
    const bool done = colouring.run();
    if (!done && how == Coalescing::All) continue;
    if (!done && colouring.spilled().empty())
      throw UserError(
          SourceLocation{program.name},
          fmt::format("an instruction needs more values at once than fit into {} registers", max_registers),
          "raise max_registers; rt.trace alone reads up to 17");
    std::vector<bool> chosen(program.registers.size());
    for (VirtualRegister r : colouring.spilled()) chosen[r] = true;
    SpillPlan plan{std::vector<VirtualRegister>(program.registers.size(), kNoRegister), &unspillable};
    out.slot.resize(program.registers.size());
    for (VirtualRegister r = 0; r < plan.group.size(); ++r) {
      if (!graph.has(r)) continue;
      const VirtualRegister representative = graph.representative(r);
      out.slot[r] = colouring.slot(representative);
      if (chosen[representative]) plan.group[r] = representative;
    }
    if (done) return true;
    spill(program, ops, plan);
    return false;
  }
  return false;
}

}  // namespace

Allocation allocate(VirtualProgram& program, uint32_t max_registers, const Ops& ops) {
  if (max_registers < kFewestRegisters || max_registers > uint32_t(isa::kMaxRegisters))
    throw UserError(SourceLocation{program.name},
                    fmt::format("max_registers is {}, expected {} to {}", max_registers, kFewestRegisters,
                                isa::kMaxRegisters));
  Allocation out;
  std::vector<bool> unspillable(program.registers.size());
  for (RegisterFile file : {RegisterFile::Predicates, RegisterFile::Registers}) {
    relieve(program, file, max_registers, ops, unspillable);
    while (!colour_file(program, file, max_registers, ops, unspillable, out)) {
    }
  }
  return out;
}

}  // namespace glint::frontend
