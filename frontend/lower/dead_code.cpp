// Removes instructions whose results are never needed. It marks backwards from effects over all definitions.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string_view>

#include "frontend/lower/lowering.h"

namespace glint::frontend {
namespace {

bool has_effect(const VirtualInst& inst) {
  return inst.kind != VirtualInst::Kind::Real ||
         !isa::effect_row(isa::op_table()[inst.op].effect).freedom.may_drop;
}

size_t num_destinations(const VirtualInst& inst) {
  size_t slots = 0;
  for (isa::OperandKind kind : isa::op_table()[inst.op].operands.view())
    if (isa::is_destination(kind)) slots += size_t(isa::slots_of(kind));
  return slots;  // Destinations come first in every row.
}

// Turns an atomic whose old value nobody reads into a reduction, which hardware sends without waiting for an
// answer.
void drop_result(VirtualInst* inst) {
  const std::string_view reduction = isa::op_table()[inst->op].reduction;
  if (reduction.empty()) return;
  inst->op = isa::op_index(reduction);
  inst->operands.erase(inst->operands.begin());
}

}  // namespace

void remove_dead_code(VirtualProgram* program) {
  std::vector<std::vector<const VirtualInst*>> definitions(program->registers.size());
  std::vector<uint8_t> needed(program->registers.size(), 0);
  std::vector<VirtualRegister> work;
  const auto need = [&](VirtualRegister r) {
    if (r != kNoRegister && !needed[r]) {
      needed[r] = 1;
      work.push_back(r);
    }
  };
  const auto need_sources = [&](const VirtualInst& inst, size_t first) {
    need(inst.guard);
    for (size_t i = first; i < inst.operands.size(); ++i)
      if (inst.operands[i].kind == Operand::Kind::Register) need(inst.operands[i].reg);
  };
  for (const VirtualBlock& block : program->blocks)
    for (const VirtualInst& inst : block.code) {
      if (has_effect(inst)) {
        need_sources(inst, num_destinations(inst));
        continue;
      }
      for (size_t i = 0; i < num_destinations(inst); ++i) definitions[inst.operands[i].reg].push_back(&inst);
    }
  while (!work.empty()) {
    const VirtualRegister r = work.back();
    work.pop_back();
    for (const VirtualInst* inst : definitions[r]) need_sources(*inst, num_destinations(*inst));
  }
  const auto is_dead = [&](const VirtualInst& inst) {
    if (has_effect(inst)) return false;
    for (size_t i = 0; i < num_destinations(inst); ++i)
      if (needed[inst.operands[i].reg]) return false;
    return true;
  };
  for (VirtualBlock& block : program->blocks)
    for (VirtualInst& inst : block.code)
      if (inst.kind == VirtualInst::Kind::Real && num_destinations(inst) == 1 &&
          !needed[inst.operands[0].reg])
        drop_result(&inst);
  for (VirtualBlock& block : program->blocks)
    block.code.erase(std::remove_if(block.code.begin(), block.code.end(), is_dead), block.code.end());
}

}  // namespace glint::frontend
