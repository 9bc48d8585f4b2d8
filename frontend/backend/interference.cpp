// Builds the graph from definition points and merges the ends of moves.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/interference.h"

#include <algorithm>

namespace glint::frontend {

uint32_t blocked_by(RegisterClass self, RegisterClass neighbour) {
  // A pair takes two single registers, a single register spoils one pair, and a pair takes one pair.
  return self == RegisterClass::B32 && neighbour == RegisterClass::B64 ? 2 : 1;
}

uint32_t slots_for(RegisterClass self, uint32_t max_registers) {
  switch (self) {
    case RegisterClass::Predicate:
      return isa::kNumPredicates;
    case RegisterClass::B32:
      return max_registers - 1;  // all but the stack pointer
    case RegisterClass::B64:
      return max_registers / 2 - 1;  // all but (%r0, %r1)
  }
  return 0;
}

InterferenceGraph::InterferenceGraph(const VirtualProgram& program, const Liveness& liveness, const Ops& ops,
                                     RegisterFile file, const std::vector<float>& weights,
                                     const std::vector<bool>* only)
    : classes_(program.registers) {
  const size_t registers = program.registers.size();
  node_of_.assign(registers, kNoRegister);
  neighbours_.resize(registers);
  wishes_.resize(registers);
  parent_.resize(registers);
  visited_.resize(registers);
  for (VirtualRegister r = 0; r < registers; ++r) {
    parent_[r] = r;
    if (file_of(classes_[r]) != file || (only && !(*only)[r])) continue;
    node_of_[r] = uint32_t(nodes_.size());
    nodes_.push_back(r);
  }
  edges_ = PairSet(nodes_.size());
  for (BlockId b = 0; b < program.blocks.size(); ++b)
    scan_block(program, liveness.out[b], ops, b, weights[b]);
}

void InterferenceGraph::scan_block(const VirtualProgram& program, const RegisterSet& live_out, const Ops& ops,
                                   BlockId block, float weight) {
  LiveWalk walk(live_out);
  const std::vector<VirtualInst>& code = program.blocks[block].code;
  for (size_t i = code.size(); i-- > 0;) {
    const VirtualInst& inst = code[i];
    // The ends of a move hold the same value, so they may share a register even while the source lives on.
    const bool is_copy =
        is_real(inst) && ops.is_move(inst.op) && !is_guarded(inst) && is_register(inst.operands[1]);
    add_edges(inst, walk.live(), is_copy ? inst.operands[1].reg : kNoRegister);
    if (is_copy && has(inst.operands[0].reg) && has(inst.operands[1].reg))
      moves_.push_back({inst.operands[0].reg, inst.operands[1].reg, weight});
    if (is_real(inst)) note_wishes(inst, ops, weight);
    walk.step(inst);
  }
}

void InterferenceGraph::add_edges(const VirtualInst& inst, const RegisterSet& live, VirtualRegister exempt) {
  for_each_def(inst, [&](VirtualRegister def) {
    if (!has(def)) return;
    live.for_each([&](VirtualRegister other) {
      if (other != exempt && has(other)) add_edge(def, other);
    });
    for_each_def(inst, [&](VirtualRegister other) {
      if (has(other)) add_edge(def, other);
    });
  });
}

void InterferenceGraph::note_wishes(const VirtualInst& inst, const Ops& ops, float weight) {
  const auto both = [&](size_t of, size_t other, int offset) {
    const VirtualOperand &a = inst.operands[of], &b = inst.operands[other];
    if (is_register(a) && is_register(b) && has(a.reg) && has(b.reg)) wish(a.reg, b.reg, offset, weight);
  };
  if (ops.is_move(inst.op) || inst.op == ops.low_word) both(0, 1, 0);
  if (inst.op == ops.pack) {
    both(1, 0, 0);
    both(2, 0, 1);
  }
  if (inst.op == ops.unpack) {
    both(0, 2, 0);
    both(1, 2, 1);
  }
}

void InterferenceGraph::wish(VirtualRegister a, VirtualRegister b, int offset, float weight) {
  wishes_[a].push_back({b, offset, weight});
  wishes_[b].push_back({a, -offset, weight});
}

bool InterferenceGraph::interfere(VirtualRegister a, VirtualRegister b) const {
  return edges_.contains(node_of_[a], node_of_[b]);
}

void InterferenceGraph::add_edge(VirtualRegister a, VirtualRegister b) {
  if (a == b || interfere(a, b)) return;
  edges_.insert(node_of_[a], node_of_[b]);
  neighbours_[a].push_back(b);
  neighbours_[b].push_back(a);
}

VirtualRegister InterferenceGraph::representative(VirtualRegister r) const {
  while (parent_[r] != r) r = parent_[r] = parent_[parent_[r]];
  return r;
}

bool InterferenceGraph::safe_to_merge(VirtualRegister a, VirtualRegister b, uint32_t max_registers) const {
  const RegisterClass self = classes_[a];
  const uint32_t slots = slots_for(self, max_registers);
  uint32_t significant = 0;
  ++visit_;
  for (VirtualRegister from : {a, b})
    for (VirtualRegister neighbour : neighbours_[from]) {
      const VirtualRegister n = representative(neighbour);
      if (visited_[n] == visit_) continue;
      visited_[n] = visit_;
      if (neighbours_[n].size() + 1 < slots_for(classes_[n], max_registers)) continue;
      significant += blocked_by(self, classes_[n]);
      if (significant >= slots) return false;  // This decides most moves of large shaders early.
    }
  return true;
}

void InterferenceGraph::merge(VirtualRegister into, VirtualRegister gone) {
  parent_[gone] = into;
  for (VirtualRegister n : neighbours_[gone]) add_edge(into, representative(n));
  wishes_[into].insert(wishes_[into].end(), wishes_[gone].begin(), wishes_[gone].end());
}

void InterferenceGraph::coalesce(Coalescing how, uint32_t max_registers, const std::vector<bool>& pinned) {
  std::stable_sort(moves_.begin(), moves_.end(),
                   [](const Move& a, const Move& b) { return a.weight > b.weight; });
  for (const Move& move : moves_) {
    const VirtualRegister to = representative(move.to), from = representative(move.from);
    if (to == from || pinned[to] != pinned[from] || interfere(to, from)) continue;
    if (how == Coalescing::Safe && !safe_to_merge(to, from, max_registers)) continue;
    merge(std::min(to, from), std::max(to, from));
  }
  std::erase_if(nodes_, [&](VirtualRegister r) { return representative(r) != r; });
}

}  // namespace glint::frontend
