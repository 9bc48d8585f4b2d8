// Lowers branches, calls and ends.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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
  const bool in_call = !calls_.empty() && !whole_kernel;
  BlockId target = in_call ? calls_.back().second : kNoBlock;
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

void KernelLowering::lower_call(const Instruction& inst) {
  size_t at = 0;
  const std::vector<Operand> none;
  const bool has_results = !inst.operands.empty() && inst.operands[0].kind == Operand::Kind::List;
  const std::vector<Operand>& results = has_results ? inst.operands[at++].parts : none;
  if (at >= inst.operands.size() || inst.operands[at].kind != Operand::Kind::Name)
    return error(inst.position, "'call' takes the name of a function");
  const Operand& name = inst.operands[at++];
  const bool has_arguments = at < inst.operands.size() && inst.operands[at].kind == Operand::Kind::List;
  const std::vector<Operand>& arguments = has_arguments ? inst.operands[at].parts : none;
  const auto f = functions_.find(name.name);
  if (f == functions_.end()) {
    if (find(name.name))
      return no_support(name.position,
                        "not supported: calls through a register: calls must name their function");
    return error(name.position, fmt::format("there is no function '{}'", name.name));
  }
  const Function& callee = *f->second;
  if (!callee.has_body)
    return no_support(
        name.position,
        fmt::format("function '{}' has no body in this module, and Glint does not link modules", name.name),
        name.name == "vprintf" ? "kernels cannot print here; leave printf and assert out" : "");
  if (std::any_of(calls_.begin(), calls_.end(), [&](const auto& open) { return open.first == &callee; }))
    return no_support(
        name.position,
        fmt::format("'{}' calls itself, but functions are inlined into their caller", name.name));
  if (callee.parameters.size() != arguments.size() || callee.results.size() != results.size())
    return error(
        inst.position,
        fmt::format("'{}' takes {} parameters and gives {} results, but the call has {} and {}", name.name,
                    callee.parameters.size(), callee.results.size(), arguments.size(), results.size()));
  inline_call(inst, callee, results, arguments);
}

// Binds a parameter of a function. A parameter in .param space is a list of words: those of the variable that
// the caller names, or a copy of a register or number. A parameter in a register is a register of its own.
Symbol KernelLowering::bind_parameter(const Declaration& formal, const Operand* actual) {
  const Symbol* given = actual && actual->kind == Operand::Kind::Name ? find(actual->name) : nullptr;
  if (given && given->kind == Symbol::Kind::Parameter && formal.space == VariableSpace::Param) {
    if (given->elements.size() * 4 < formal.bytes())
      error(actual->position,
            fmt::format("'{}' has fewer bytes than parameter '{}'", actual->name, formal.name));
    return *given;
  }
  Symbol symbol;
  symbol.type = formal.type;
  const bool wide = class_of(formal.type) == RegisterClass::B64;
  if (formal.space == VariableSpace::Register) {
    symbol.reg = temporary(class_of(formal.type));
  } else {
    symbol.kind = Symbol::Kind::Parameter;
    for (uint64_t i = 0; i < (formal.bytes() + 3) / 4; ++i)
      symbol.elements.push_back(temporary(RegisterClass::B32));
  }
  if (!actual) return symbol;
  if (formal.space == VariableSpace::Register) {
    if (formal.type.kind == 'p')
      emit(isa::op_index("mov.pred"), {VirtualOperand::of(symbol.reg), predicate_source(*actual)});
    else
      emit(isa::op_index(wide ? "mov.b64" : "mov.b32"),
           {VirtualOperand::of(symbol.reg),
            source(*actual, wide ? isa::OperandKind::Src64 : isa::OperandKind::Src32, formal.type)});
  } else {
    MemoryForm form;
    form.type = formal.type;
    store_word_part(form, symbol, 0, *actual);
  }
  return symbol;
}

void KernelLowering::inline_call(const Instruction& inst, const Function& callee,
                                 const std::vector<Operand>& results, const std::vector<Operand>& arguments) {
  const BlockId behind = new_block("");
  if (guard_ != kNoRegister) {
    const BlockId inside = new_block("");
    end_branch(guard_, !guard_negate_, behind, inside, has_word(inst.words, "uni"));
    begin(inside);
    guard_ = kNoRegister;
  }
  Scope scope;
  scope.is_function = true;
  for (size_t i = 0; i < arguments.size(); ++i)
    scope.names[callee.parameters[i].name] = bind_parameter(callee.parameters[i], &arguments[i]);
  // Results in registers are copied to the caller's registers afterwards.
  std::vector<std::pair<Symbol, const Operand*>> copies;
  for (size_t i = 0; i < results.size(); ++i) {
    const Symbol* given = find(results[i].name);
    const bool same_words =
        given && given->kind == Symbol::Kind::Parameter && callee.results[i].space == VariableSpace::Param;
    const Symbol symbol = bind_parameter(callee.results[i], same_words ? &results[i] : nullptr);
    scope.names[callee.results[i].name] = symbol;
    if (!same_words) copies.emplace_back(symbol, &results[i]);
  }
  const isa::Line caller = line_;
  const BlockId back = copies.empty() ? behind : new_block("");
  calls_.emplace_back(&callee, back);
  scopes_.push_back(std::move(scope));
  predeclare_labels(callee.body);
  statements(callee.body);
  line_ = caller;
  end_goto(back);
  scopes_.pop_back();
  calls_.pop_back();
  guard_ = kNoRegister;
  if (!copies.empty()) {
    begin(back);
    for (const auto& [symbol, to] : copies) {
      MemoryForm form;
      form.type = symbol.type;
      if (symbol.kind == Symbol::Kind::Parameter) {
        load_word_part(form, symbol, 0, *to);
      } else {
        const RegisterClass c = class_of(symbol.type);
        const isa::OperandKind kind = c == RegisterClass::Predicate ? isa::OperandKind::DstPred
                                      : c == RegisterClass::B64     ? isa::OperandKind::Dst64
                                                                    : isa::OperandKind::Dst32;
        emit(isa::op_index(c == RegisterClass::Predicate ? "mov.pred"
                           : c == RegisterClass::B64     ? "mov.b64"
                                                         : "mov.b32"),
             {destination(*to, kind, symbol.type), VirtualOperand::of(symbol.reg)});
        finish_moves();
      }
    }
    end_goto(behind);
  }
  begin(behind);
}

}  // namespace glint::frontend::ptx
