// Follows constants and parameters through integer ops.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/uniform.h"

#include "frontend/backend/def_use.h"
#include "frontend/backend/memory_use.h"

namespace glint::frontend {
namespace {

bool is_uniform(const VirtualInst& inst, const DefUse& registers, const std::vector<bool>& known) {
  if (!is_real(inst) || is_guarded(inst)) return false;
  const isa::OpRow& row = row_of(inst);
  const bool computes = is_pure(inst) && (row.unit == isa::Unit::Int || row.unit == isa::Unit::Move);
  if (!computes && !memory_use(inst).reads_constants()) return false;
  bool holds = true;
  for_each_slot(row, [&](size_t slot, isa::OperandKind kind) {
    const VirtualOperand& o = inst.operands[slot];
    holds = holds && (isa::is_destination(kind) ? registers.definition(o) == &inst
                                                : is_constant(o) || (is_register(o) && known[o.reg]));
  });
  return holds;
}

}  // namespace

std::vector<bool> find_uniform(VirtualProgram& program) {
  const DefUse registers(program);
  std::vector<bool> known(program.registers.size());
  for (bool grows = true; grows;) {
    grows = false;
    for (const VirtualBlock& block : program.blocks)
      for (const VirtualInst& inst : block.code)
        if (is_uniform(inst, registers, known))
          for_each_def(inst, [&](VirtualRegister r) {
            grows |= !known[r];
            known[r] = true;
          });
  }
  return known;
}

}  // namespace glint::frontend
