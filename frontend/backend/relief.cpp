// Chooses by cost and length of life, as D. Bernstein et al., "Spill code minimization techniques for
// optimizing compilers" (1989), but with the distance between a value's first and last place for its area.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/relief.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

#include "frontend/backend/spill.h"
#include "frontend/backend/spill_costs.h"

namespace glint::frontend {
namespace {

// Returns the registers of a file that a move reads or writes.
std::vector<bool> moved_registers(const VirtualProgram& program, const Ops& ops) {
  std::vector<bool> out(program.registers.size());
  for (const VirtualBlock& block : program.blocks)
    for (const VirtualInst& inst : block.code)
      if (is_real(inst) && ops.is_move(inst.op) && !is_guarded(inst) && is_register(inst.operands[1]))
        out[inst.operands[0].reg] = out[inst.operands[1].reg] = true;
  return out;
}

// Walks a block backwards and tells which registers begin and end to be live.
class LifeWalk {
 public:
  explicit LifeWalk(RegisterSet live_out) : walk_(std::move(live_out)) {}

  template <class Enter, class Leave>
  void step(const VirtualInst& inst, Enter&& enter, Leave&& leave) {
    met_.clear();
    const auto meet = [&](VirtualRegister r) {
      const auto is_same = [&](const auto& each) { return each.first == r; };
      if (std::none_of(met_.begin(), met_.end(), is_same)) met_.emplace_back(r, walk_.live().contains(r));
    };
    for_each_def(inst, meet);
    for_each_use(inst, meet);
    walk_.step(inst);
    for (const auto& [r, lived] : met_) {
      const bool lives = walk_.live().contains(r);
      if (lives && !lived) enter(r);
      if (!lives && lived) leave(r);
    }
  }

  bool is_live(VirtualRegister r) const { return walk_.live().contains(r); }

 private:
  LiveWalk walk_;
  std::vector<std::pair<VirtualRegister, bool>> met_;  // by the instruction; whether they live behind it
};

class Relief {
 public:
  Relief(const VirtualProgram& program, const Liveness& liveness, RegisterFile file, uint32_t max_registers,
         const Ops& ops, const std::vector<bool>& unspillable)
      : program_(program),
        liveness_(liveness),
        file_(file),
        group_(program.registers.size()),
        members_of_(program.registers.size()),
        rank_(program.registers.size()),
        members_(program.registers.size()),
        spilled_(program.registers.size()),
        is_spilled_(program.registers.size()) {
    // Choice: what is left free is for the values of spill code and for pairs.
    const uint32_t slots = slots_for(
        file == RegisterFile::Predicates ? RegisterClass::Predicate : RegisterClass::B32, max_registers);
    most_ = slots - slots / 8 - 1;
    const std::vector<float> weights = block_weights(program);
    const std::vector<bool> moved = moved_registers(program, ops);
    InterferenceGraph graph(program, liveness, ops, file, weights, &moved);
    graph.coalesce(Coalescing::All, max_registers, unspillable);
    SpillCosts costs(program, liveness, weights);
    costs.merge(graph, unspillable);
    rank(graph, costs);
  }

  std::vector<VirtualRegister> run() {
    for (BlockId b = 0; b < program_.blocks.size(); ++b) walk(b);
    std::vector<VirtualRegister> out(program_.registers.size(), kNoRegister);
    for (VirtualRegister r = 0; r < out.size(); ++r)
      if (is_in_file(r) && is_spilled_[group_[r]]) out[r] = group_[r];
    return out;
  }

 private:
  bool is_in_file(VirtualRegister r) const { return file_of(program_.registers[r]) == file_; }
  uint32_t slots_of(VirtualRegister r) const { return program_.registers[r] == RegisterClass::B64 ? 2 : 1; }

  void rank(const InterferenceGraph& graph, const SpillCosts& costs) {
    std::vector<uint32_t> first(group_.size(), UINT32_MAX), last(group_.size());
    for (VirtualRegister r = 0; r < group_.size(); ++r) {
      group_[r] = graph.has(r) ? graph.representative(r) : r;
      members_of_[group_[r]].push_back(r);
    }
    uint32_t at = 0;
    for (const VirtualBlock& block : program_.blocks)
      for (const VirtualInst& inst : block.code) {
        const auto meet = [&](VirtualRegister r) {
          first[group_[r]] = std::min(first[group_[r]], at);
          last[group_[r]] = at;
        };
        for_each_def(inst, meet);
        for_each_use(inst, meet);
        ++at;
      }
    for (VirtualRegister r = 0; r < group_.size(); ++r) {
      if (!is_in_file(r) || group_[r] != r || first[r] > last[r]) continue;
      rank_[r] = costs.of(r) / float(last[r] - first[r] + 1);
      if (costs.of(r) < 0) give_up(r);
    }
  }

  void give_up(VirtualRegister group) {
    is_spilled_[group] = true;
    for (const VirtualRegister r : members_of_[group]) spilled_.insert(r);
  }

  void enter(VirtualRegister r) {
    if (!is_in_file(r) || is_spilled_[group_[r]]) return;
    if (members_[group_[r]]++ > 0) return;
    slots_ += slots_of(r);
    live_.insert({rank_[group_[r]], group_[r]});
  }
  void leave(VirtualRegister r) {
    if (!is_in_file(r) || is_spilled_[group_[r]] || --members_[group_[r]] > 0) return;
    slots_ -= slots_of(r);
    live_.erase({rank_[group_[r]], group_[r]});
  }
  void reduce() {
    while (slots_ > most_ && !live_.empty() && live_.begin()->first != kNeverSpill) {
      const VirtualRegister group = live_.begin()->second;
      live_.erase(live_.begin());
      slots_ -= slots_of(group);
      give_up(group);
    }
  }

  void walk(BlockId b) {
    RegisterSet out = liveness_.out[b];
    out.subtract(spilled_);
    for (const auto& [rank, group] : live_) members_[group] = 0;
    live_.clear();
    slots_ = 0;
    out.for_each([&](VirtualRegister r) { enter(r); });
    reduce();
    LifeWalk walk(std::move(out));
    const std::vector<VirtualInst>& code = program_.blocks[b].code;
    for (size_t i = code.size(); i-- > 0;) {
      walk.step(
          code[i], [&](VirtualRegister r) { enter(r); }, [&](VirtualRegister r) { leave(r); });
      reduce();
    }
  }

  const VirtualProgram& program_;
  const Liveness& liveness_;
  const RegisterFile file_;
  uint32_t most_ = 0;
  std::vector<VirtualRegister> group_;
  std::vector<std::vector<VirtualRegister>> members_of_;
  std::vector<float> rank_;        // of groups: cost for each instruction of its length
  std::vector<uint32_t> members_;  // of groups: those that live now
  RegisterSet spilled_;            // registers
  std::vector<bool> is_spilled_;   // groups
  std::set<std::pair<float, VirtualRegister>> live_;
  uint32_t slots_ = 0;
};

}  // namespace

uint64_t count_edges(const VirtualProgram& program, const Liveness& liveness, RegisterFile file) {
  RegisterSet others(program.registers.size());
  for (VirtualRegister r = 0; r < program.registers.size(); ++r)
    if (file_of(program.registers[r]) != file) others.insert(r);
  uint64_t edges = 0;
  for (BlockId b = 0; b < program.blocks.size(); ++b) {
    RegisterSet out = liveness.out[b];
    out.subtract(others);
    uint64_t live = out.size();
    LifeWalk walk(std::move(out));
    const std::vector<VirtualInst>& code = program.blocks[b].code;
    for (size_t i = code.size(); i-- > 0;) {
      for_each_def(code[i], [&](VirtualRegister r) {
        if (!others.contains(r)) edges += live - walk.is_live(r);
      });
      walk.step(
          code[i], [&](VirtualRegister r) { live += !others.contains(r); },
          [&](VirtualRegister r) { live -= !others.contains(r); });
    }
  }
  return edges;
}

void relieve(VirtualProgram& program, RegisterFile file, uint32_t max_registers, const Ops& ops,
             std::vector<bool>& unspillable, uint64_t most_edges) {
  const uint64_t registers = program.registers.size();
  if (registers * registers / 2 <= most_edges) return;  // A graph has no more edges than pairs.
  const Liveness liveness = find_liveness(program);
  if (count_edges(program, liveness, file) <= most_edges) return;
  SpillPlan plan{Relief(program, liveness, file, max_registers, ops, unspillable).run(), &unspillable};
  spill(program, ops, plan);
}

}  // namespace glint::frontend
