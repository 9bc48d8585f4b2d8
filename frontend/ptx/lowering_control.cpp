// Lowers branches and ends.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "frontend/ptx/lowering.h"

namespace glint::frontend::ptx {

bool KernelLowering::lower_control(const Instruction& inst) {
  const std::string& op = inst.words[0];
  if (op == "bra")
    lower_branch(inst);
  else if (op == "brx")
    lower_indexed_branch(inst);
  else if (op == "ret" || op == "exit")
    lower_return(inst, op == "exit");
  else if (op == "call")
    lower_call(inst);
  else
    return false;
  return true;
}

BlockId KernelLowering::label(const std::string& name, TextPosition position) {
  const Symbol* symbol = find(name);
  if (symbol && symbol->kind == Symbol::Kind::Label) return symbol->block;
  error(position, fmt::format("there is no label '{}' here", name));
  return new_block(name);
}

void KernelLowering::lower_branch(const Instruction& inst) {
  if (inst.operands.size() != 1 || inst.operands[0].kind != Operand::Kind::Name)
    return error(inst.position, "'bra' takes a label");
  const BlockId target = label(inst.operands[0].name, inst.operands[0].position);
  if (guard_ == kNoRegister) return end_goto(target);
  const BlockId next = new_block("");
  end_branch(guard_, guard_negate_, target, next, has_word(inst.words, "uni"));
  begin(next);
}

// Lowers an indexed branch. Model: it becomes a chain of comparisons, not a jump through a table. An index
// past the list goes to the last label, which PTX leaves undefined.
void KernelLowering::lower_indexed_branch(const Instruction& inst) {
  const Symbol* list = inst.operands.size() == 2 ? find(inst.operands[1].name) : nullptr;
  if (!list || list->kind != Symbol::Kind::Targets || list->targets->empty())
    return error(inst.position, "'brx.idx' takes an index and the name of a .branchtargets list");
  const BlockId behind = new_block("");
  if (guard_ != kNoRegister) {
    const BlockId inside = new_block("");
    end_branch(guard_, !guard_negate_, behind, inside, false);
    begin(inside);
  }
  const VirtualOperand index = source(inst.operands[0], isa::OperandKind::Src32, {'u', 32});
  const bool uniform = has_word(inst.words, "uni");
  for (size_t i = 0; i + 1 < list->targets->size(); ++i) {
    const VirtualOperand here = compute_predicate("setp.eq.u32", {index, VirtualOperand::value(i)});
    const BlockId next = new_block("");
    end_branch(here.reg, false, label((*list->targets)[i], inst.position), next, uniform);
    begin(next);
  }
  end_goto(label(list->targets->back(), inst.position));
  if (guard_ != kNoRegister) begin(behind);
}

void KernelLowering::lower_return(const Instruction& inst, bool whole_kernel) {
  const bool in_call = !returns_to_.empty() && !whole_kernel;
  BlockId target = in_call ? returns_to_.back() : kNoBlock;
  if (guard_ == kNoRegister) return in_call ? end_goto(target) : end_exit();
  const BlockId next = new_block("");
  if (!in_call) target = new_block("");
  end_branch(guard_, guard_negate_, target, next, has_word(inst.words, "uni"));
  if (!in_call) {
    begin(target);
    end_exit();
  }
  begin(next);
}

}  // namespace glint::frontend::ptx
