// Lowers calls: most functions become part of their caller, and the others have code of their own.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "frontend/ptx/lowering.h"

namespace glint::frontend::ptx {
namespace {

// The frame of a function begins with its parameters and then its results, a word for each 32 bits. Model:
// hardware passes them in registers as far as there are some. Choice: this part is never empty, so that no
// variable of a function has the stack pointer itself as its address.
constexpr uint32_t kLeastFrame = 16;

uint32_t words_of(const Declaration& d) {
  return uint32_t((d.bytes() + 3) / 4);
}
uint32_t bytes_of(const std::vector<Declaration>& list) {
  uint32_t words = 0;
  for (const Declaration& d : list) words += words_of(d);
  return words * 4;
}

MemoryForm form_of(const Declaration& d) {
  MemoryForm form;
  form.type = d.type;
  return form;
}

Operand name_of(const Declaration& d) {
  Operand o;
  o.kind = Operand::Kind::Name;
  o.name = d.name;
  o.position = d.position;
  return o;
}

bool fits(const std::vector<Declaration>& formal, const std::vector<Operand>& actual) {
  return formal.size() == actual.size();
}

}  // namespace

void KernelLowering::lower_call(const Instruction& inst) {
  size_t at = 0;
  Call call;
  if (!inst.operands.empty() && inst.operands[0].kind == Operand::Kind::List)
    call.results = inst.operands[at++].parts;
  if (at >= inst.operands.size() || inst.operands[at].kind != Operand::Kind::Name)
    return error(inst.position, "'call' takes the name of a function");
  const Operand& name = inst.operands[at++];
  call.name = name.name;
  if (at < inst.operands.size() && inst.operands[at].kind == Operand::Kind::List)
    call.arguments = inst.operands[at++].parts;
  const auto f = functions_.find(name.name);
  if (f != functions_.end())
    call.signature = call.callee = f->second;
  else if (!find_callee(inst, name, at, call))
    return;
  if (!fits(call.signature->parameters, call.arguments) || !fits(call.signature->results, call.results))
    return error(inst.position,
                 fmt::format("'{}' takes {} parameters and gives {} results, but the call has {} and {}",
                             name.name, call.signature->parameters.size(), call.signature->results.size(),
                             call.arguments.size(), call.results.size()));
  const BlockId behind = new_block("");
  if (guard_ != kNoRegister) {
    const BlockId inside = new_block("");
    end_branch(guard_, !guard_negate_, behind, inside, has_word(inst.words, "uni"));
    begin(inside);
    guard_ = kNoRegister;
  }
  if (call.callee && !call.callee->has_body) {
    if (!lower_runtime_call(call))
      no_support(name.position,
                 fmt::format("function '{}' has no body in this module, and Glint does not link modules",
                             name.name));
    end_goto(behind);
  } else if (call.callee && !graph_.is_called(*call.callee)) {
    inline_call(call, behind);
  } else {
    call_function(call);
    end_goto(behind);
  }
  begin(behind);
}

// Finds what a call through a register takes and gives: its last operand names a prototype or a list of
// functions. Returns false after an error.
bool KernelLowering::find_callee(const Instruction& inst, const Operand& name, size_t at, Call& call) {
  if (!find(name.name)) {
    error(name.position, fmt::format("there is no function '{}'", name.name));
    return false;
  }
  const Symbol* const type = at < inst.operands.size() ? find(inst.operands[at].name) : nullptr;
  if (type && type->kind == Symbol::Kind::Prototype) call.signature = type->signature;
  if (type && type->kind == Symbol::Kind::Targets)
    if (const auto f = functions_.find(type->targets->front()); f != functions_.end())
      call.signature = f->second;
  if (!call.signature) {
    error(name.position,
          fmt::format("a call through the register '{}' ends with the name of a .callprototype or of a "
                      ".calltargets list",
                      name.name));
    return false;
  }
  call.number = compute32("cvt.u32.u64", {source(name, isa::OperandKind::Src64, {'u', 64})});
  return true;
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

void KernelLowering::inline_call(const Call& call, BlockId behind) {
  const Function& callee = *call.callee;
  Scope scope;
  scope.is_function = true;
  for (size_t i = 0; i < call.arguments.size(); ++i)
    scope.names[callee.parameters[i].name] = bind_parameter(callee.parameters[i], &call.arguments[i]);
  // Results in registers are copied to the caller's registers afterwards.
  std::vector<std::pair<Symbol, const Operand*>> copies;
  for (size_t i = 0; i < call.results.size(); ++i) {
    const Symbol* given = find(call.results[i].name);
    const bool same_words =
        given && given->kind == Symbol::Kind::Parameter && callee.results[i].space == VariableSpace::Param;
    const Symbol symbol = bind_parameter(callee.results[i], same_words ? &call.results[i] : nullptr);
    scope.names[callee.results[i].name] = symbol;
    if (!same_words) copies.emplace_back(symbol, &call.results[i]);
  }
  const isa::Line caller = line_;
  const BlockId back = copies.empty() ? behind : new_block("");
  returns_to_.push_back(back);
  scopes_.push_back(std::move(scope));
  predeclare_labels(callee.body);
  statements(callee.body);
  line_ = caller;
  end_goto(back);
  scopes_.pop_back();
  returns_to_.pop_back();
  guard_ = kNoRegister;
  if (copies.empty()) return;
  begin(back);
  for (const auto& [symbol, to] : copies) copy_result(symbol, *to);
  end_goto(behind);
}

// Copies a result to the caller's register.
void KernelLowering::copy_result(const Symbol& symbol, const Operand& to) {
  MemoryForm form;
  form.type = symbol.type;
  if (symbol.kind == Symbol::Kind::Parameter) return load_word_part(form, symbol, 0, to);
  const RegisterClass c = class_of(symbol.type);
  const isa::OperandKind kind = c == RegisterClass::Predicate ? isa::OperandKind::DstPred
                                : c == RegisterClass::B64     ? isa::OperandKind::Dst64
                                                              : isa::OperandKind::Dst32;
  emit(isa::op_index(c == RegisterClass::Predicate ? "mov.pred"
                     : c == RegisterClass::B64     ? "mov.b64"
                                                   : "mov.b32"),
       {destination(to, kind, symbol.type), VirtualOperand::of(symbol.reg)});
  finish_moves();
}

// Moves words between registers and a frame, from byte `at` of it on.
void KernelLowering::move_frame_words(bool is_store, const VirtualOperand& frame, uint32_t at,
                                      const std::vector<VirtualRegister>& words) {
  static constexpr std::array<const char*, 3> kStores{"st.local.b32", "st.local.v2.b32", "st.local.v4.b32"},
      kLoads{"ld.local.b32", "ld.local.v2.b32", "ld.local.v4.b32"};
  for (size_t i = 0; i < words.size();) {
    const size_t left = words.size() - i, count = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    std::vector<VirtualOperand> operands;
    for (size_t k = 0; k < count; ++k) operands.push_back(VirtualOperand::of(words[i + k]));
    operands.insert(is_store ? operands.begin() : operands.end(), frame);
    compute((is_store ? kStores : kLoads)[count / 2], std::move(operands), int64_t(at + 4 * i));
    i += count;
  }
}

// Returns words for a parameter or a result, whatever the function has declared.
Symbol KernelLowering::words_for(Declaration formal, const Operand* actual) {
  if (formal.type.kind == 'p')
    no_support(
        formal.position,
        fmt::format("not supported: '{}': a predicate that a called function takes or gives", formal.name));
  formal.space = VariableSpace::Param;
  return bind_parameter(formal, actual);
}

// Calls a function that has code of its own. What stands between the first store to its frame and the last
// load from it becomes a region of calls (enclose_calls).
void KernelLowering::call_function(const Call& call) {
  std::vector<VirtualRegister> words;
  const auto append = [&](const Symbol& symbol) {
    words.insert(words.end(), symbol.elements.begin(), symbol.elements.end());
  };
  const std::vector<Declaration>& parameters = call.signature->parameters;
  for (size_t i = 0; i < call.arguments.size(); ++i) {
    Symbol symbol = words_for(parameters[i], &call.arguments[i]);
    symbol.elements.resize(words_of(parameters[i]));  // A variable may have more bytes than the parameter.
    append(symbol);
  }
  const VirtualOperand number =
      call.callee ? VirtualOperand::value(graph_.number_of(call.callee->name)) : call.number;
  move_frame_words(true, VirtualOperand::callee_frame(), 0, words);
  compute("call.function", {number});
  std::vector<std::pair<Symbol, const Operand*>> copies;
  words.clear();
  for (size_t i = 0; i < call.results.size(); ++i) {
    const Declaration& formal = call.signature->results[i];
    const Symbol* given = find(call.results[i].name);
    const bool same_words = given && given->kind == Symbol::Kind::Parameter;
    Symbol symbol = words_for(formal, same_words ? &call.results[i] : nullptr);
    symbol.elements.resize(words_of(formal));
    append(symbol);
    if (!same_words) copies.emplace_back(symbol, &call.results[i]);
  }
  move_frame_words(false, VirtualOperand::callee_frame(), bytes_of(parameters), words);
  for (const auto& [symbol, to] : copies) copy_result(symbol, *to);
}

// Lowers the body of a function that has code of its own.
void KernelLowering::lower_function(const Function& f) {
  program_.function = graph_.number_of(f.name);
  program_.local_bytes = std::max(kLeastFrame, (bytes_of(f.parameters) + bytes_of(f.results) + 15) / 16 * 16);
  std::vector<VirtualRegister> words;
  std::vector<std::pair<const Declaration*, Symbol>> copies;
  const auto declare_words = [&](const Declaration& d) {
    Symbol symbol = words_for(d, nullptr);
    words.insert(words.end(), symbol.elements.begin(), symbol.elements.end());
    if (d.space != VariableSpace::Register) {
      scopes_.back().names[d.name] = symbol;
      return;
    }
    copies.emplace_back(&d, symbol);
    scopes_.back().names[d.name] = bind_parameter(d, nullptr);
  };
  for (const Declaration& d : f.parameters) declare_words(d);
  move_frame_words(false, VirtualOperand::stack_pointer(), 0, words);
  for (const auto& [d, symbol] : copies) load_word_part(form_of(*d), symbol, 0, name_of(*d));
  words.clear();
  copies.clear();
  for (const Declaration& d : f.results) declare_words(d);
  const BlockId end = new_block("");
  returns_to_.push_back(end);
  predeclare_labels(f.body);
  statements(f.body);
  guard_ = kNoRegister;
  end_goto(end);
  begin(end);
  for (const auto& [d, symbol] : copies) store_word_part(form_of(*d), symbol, 0, name_of(*d));
  move_frame_words(true, VirtualOperand::stack_pointer(), bytes_of(f.parameters), words);
  end_exit();
  draft_.blocks[end].returns = true;
  returns_to_.clear();
}

void enclose_calls(VirtualProgram& program) {
  const uint16_t call = isa::op_index("call.function");
  for (VirtualBlock& block : program.blocks) {
    std::vector<VirtualInst> code;
    bool inside = false, has_called = false;
    const auto mark = [&](VirtualInst::Kind kind) {
      VirtualInst marker;
      marker.kind = kind;
      marker.line = code.empty() ? isa::Line{} : code.back().line;
      code.push_back(std::move(marker));
    };
    const auto in_callee = [](const VirtualInst& inst) {
      return std::ranges::any_of(
          inst.operands, [](const VirtualOperand& o) { return o.kind == VirtualOperand::Kind::CalleeFrame; });
    };
    for (VirtualInst& inst : block.code) {
      const bool belongs = in_callee(inst),
                 is_load = belongs && inst.operands[0].kind == VirtualOperand::Kind::Register;
      // The results stand right behind the call. A store is a parameter of the next call.
      if (inside && has_called && !is_load) {
        mark(VirtualInst::Kind::RestoreLive);
        inside = false;
      }
      if (!inside && (belongs || inst.op == call)) {
        mark(VirtualInst::Kind::SaveLive);
        inside = true;
        has_called = false;
      }
      has_called |= inst.op == call;
      code.push_back(std::move(inst));
    }
    if (inside) mark(VirtualInst::Kind::RestoreLive);
    block.code = std::move(code);
  }
}

}  // namespace glint::frontend::ptx
