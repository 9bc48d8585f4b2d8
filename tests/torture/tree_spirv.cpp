// Writes a tree as SPIR-V: variables as phis where they are not in memory, and branches that no GLSL has.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <deque>

#include "tests/torture/spirv_writer.h"
#include "tests/torture/tree.h"

namespace glint::test::torture {
namespace {

using enum spv::Op;
using Op = Expr::Op;
using Kind = Stmt::Kind;
using Style = Stmt::Style;

struct ModuleIds {
  Id inputs, results, own, global_id, local_id, slots;
  std::vector<Id> functions;
};

struct Phi {
  Id id;
  uint32_t variable;
  Words operands;
};

// SSA while writing, by Braun et al., "Simple and Efficient Construction of Static Single Assignment Form" (2013);
// phis that only pass one value on are kept.
struct BlockCode {
  Id label = 0;
  bool is_sealed = true, is_closed = false;  // all predecessors are known; ends with a terminator
  std::vector<BlockCode*> predecessors;
  std::map<uint32_t, Id> values;
  std::vector<Phi> phis;
  std::vector<size_t> open_phis;
  Words code;
};

// Where exits go from here.
struct Targets {
  BlockCode *loop_merge = nullptr, *loop_continue = nullptr, *nearest_merge = nullptr;
  BlockCode *leave = nullptr, *next_case = nullptr;
};

class FunctionWriter {
 public:
  FunctionWriter(SpirvWriter& writer, ModuleIds& ids, const ProgramTree& program, size_t number)
      : w_(writer), ids_(ids), program_(program), tree_(program.functions[number]), is_entry_(number + 1 == program.functions.size()) {}

  Id run();

 private:
  Id word_type() { return w_.int_type(); }
  Id type_of(Sort sort) { return sort == Sort::Word ? word_type() : sort == Sort::Bool ? w_.bool_type() : w_.float_type(); }
  Id op(spv::Op what, Id type, Words operands) {
    const Id id = w_.new_id();
    operands.insert(operands.begin(), {type, id});
    append(here_->code, what, operands);
    return id;
  }
  Id load_from(spv::StorageClass storage, Id base, Words indices) { return op(OpLoad, word_type(), {chain(storage, base, std::move(indices))}); }
  Id chain(spv::StorageClass storage, Id base, Words indices) {
    indices.insert(indices.begin(), base);
    return op(OpAccessChain, w_.pointer_to(storage, word_type()), indices);
  }
  void store(Id pointer, Id value) { append(here_->code, OpStore, {pointer, value}); }
  Id own_word(Id index) {
    const Id first = op(OpIMul, word_type(), {lane_, w_.word(kOwnWords)});
    return chain(spv::StorageClass::StorageBuffer, ids_.own, {w_.word(0), op(OpIAdd, word_type(), {first, masked(index, kOwnWords - 1)})});
  }
  Id masked(Id x, uint32_t mask) { return op(OpBitwiseAnd, word_type(), {x, w_.word(mask)}); }

  BlockCode* new_block(bool sealed = true) {
    blocks_.emplace_back();
    blocks_.back().label = w_.new_id();
    blocks_.back().is_sealed = sealed;
    return &blocks_.back();
  }
  void begin(BlockCode* block) {
    here_ = block;
    order_.push_back(block);
  }
  // As begin(), for a block behind a construct: nothing may arrive there.
  void begin_merge(BlockCode* block, bool write_dead_code) {
    begin(block);
    if (block->predecessors.empty() && !write_dead_code) end(OpUnreachable, {});
  }
  void end(spv::Op what, const Words& operands) {
    append(here_->code, what, operands);
    here_->is_closed = true;
  }
  void edge(BlockCode* to) {
    if (std::find(to->predecessors.begin(), to->predecessors.end(), here_) == to->predecessors.end()) to->predecessors.push_back(here_);
  }
  void branch(BlockCode* to) {
    if (here_->is_closed) return;
    edge(to);
    end(OpBranch, {to->label});
  }
  void branch_if(Id condition, BlockCode* yes, BlockCode* no) {
    edge(yes);
    edge(no);
    end(OpBranchConditional, {condition, yes->label, no->label});
  }
  void merge(BlockCode* at) { append(here_->code, OpSelectionMerge, {at->label, 0}); }
  void loop_merge(BlockCode* at, BlockCode* target) { append(here_->code, OpLoopMerge, {at->label, target->label, 0}); }

  Id read(uint32_t variable, BlockCode* block);
  void fill(BlockCode* block, size_t phi);
  void seal(BlockCode* block);
  Id get(uint32_t variable) {
    if (memory_[variable]) return op(OpLoad, type_of(tree_.variables[variable]), {memory_[variable]});
    return read(variable, here_);
  }
  void set(uint32_t variable, Id value) {
    if (memory_[variable]) return store(memory_[variable], value);
    here_->values[variable] = value;
  }

  Id value(const Expr& e);
  Id binary(const Expr& e);
  void list(const std::vector<Stmt>& stmts, const Targets& targets);
  void statement(const Stmt& s, const Targets& targets);
  void leave_function(Id result);
  BlockCode* exit_target(Kind kind, const Targets& t);
  void branch_statement(const Stmt& s, Targets targets);
  void choice(const Stmt& s, Targets targets);
  void loop(const Stmt& s, Targets targets);
  void single_block_loop(const Stmt& s);
  Id goes_on(const Stmt& s);
  void exchange(const Stmt& s);
  void count(uint32_t variable) { set(variable, op(OpIAdd, word_type(), {get(variable), w_.word(1)})); }

  SpirvWriter& w_;
  ModuleIds& ids_;
  const ProgramTree& program_;
  const FunctionTree& tree_;
  const bool is_entry_;
  std::deque<BlockCode> blocks_;
  std::vector<BlockCode*> order_;
  BlockCode* here_ = nullptr;
  std::vector<Id> memory_;  // of variables that are not phis
  Id lane_ = 0, elements_ = 0;
};

Id FunctionWriter::read(uint32_t variable, BlockCode* block) {
  if (const auto it = block->values.find(variable); it != block->values.end()) return it->second;
  Id id;
  if (block->is_sealed && block->predecessors.empty()) {
    id = w_.undefined(type_of(tree_.variables[variable]));
  } else if (block->is_sealed && block->predecessors.size() == 1) {
    id = read(variable, block->predecessors[0]);
  } else {
    id = w_.new_id();
    block->phis.push_back({id, variable, {}});
    block->values[variable] = id;
    if (block->is_sealed)
      fill(block, block->phis.size() - 1);
    else
      block->open_phis.push_back(block->phis.size() - 1);
  }
  block->values[variable] = id;
  return id;
}

void FunctionWriter::fill(BlockCode* block, size_t phi) {
  Words operands;
  for (BlockCode* from : block->predecessors) {
    operands.push_back(read(block->phis[phi].variable, from));
    operands.push_back(from->label);
  }
  block->phis[phi].operands = operands;
}

void FunctionWriter::seal(BlockCode* block) {
  block->is_sealed = true;
  for (size_t phi : std::vector<size_t>(block->open_phis)) fill(block, phi);
}

Id FunctionWriter::binary(const Expr& e) {
  const Id a = value(e.args[0]);
  Id b = value(e.args[1]);
  const Id word = word_type(), truth = w_.bool_type(), number = w_.float_type();
  switch (e.op) {
    case Op::Add: return op(OpIAdd, word, {a, b});
    case Op::Sub: return op(OpISub, word, {a, b});
    case Op::Mul: return op(OpIMul, word, {a, b});
    case Op::And: return op(OpBitwiseAnd, word, {a, b});
    case Op::Or: return op(OpBitwiseOr, word, {a, b});
    case Op::Xor: return op(OpBitwiseXor, word, {a, b});
    case Op::Shl: return op(OpShiftLeftLogical, word, {a, masked(b, 31)});
    case Op::Shr: return op(OpShiftRightLogical, word, {a, masked(b, 31)});
    case Op::Div:
    case Op::Mod:
      b = op(OpBitwiseOr, word, {b, w_.word(1)});
      return op(e.op == Op::Div ? OpUDiv : OpUMod, word, {a, b});
    case Op::Less: return op(OpULessThan, truth, {a, b});
    case Op::SignedLess: return op(OpSLessThan, truth, {a, b});
    case Op::Equal: return op(OpIEqual, truth, {a, b});
    case Op::FloatLess: return op(OpFOrdLessThan, truth, {a, b});
    case Op::Both: return op(OpLogicalAnd, truth, {a, b});
    case Op::Either: return op(OpLogicalOr, truth, {a, b});
    case Op::FloatAdd: return op(OpFAdd, number, {a, b});
    default: return op(OpFMul, number, {a, b});
  }
}

Id FunctionWriter::value(const Expr& e) {
  using Storage = spv::StorageClass;
  switch (e.op) {
    case Op::Constant: return w_.word(e.value);
    case Op::FloatConstant: return w_.declare(OpConstant, {w_.float_type(), e.value}, true);
    case Op::Variable:
    case Op::BoolVariable:
    case Op::FloatVariable: return get(e.value);
    case Op::Lane: return lane_;
    case Op::Input: return load_from(Storage::StorageBuffer, ids_.inputs, {w_.word(0), masked(value(e.args[0]), kInputWords - 1)});
    case Op::Element: return load_from(Storage::Function, elements_, {masked(value(e.args[0]), kElements - 1)});
    case Op::Own: return op(OpLoad, word_type(), {own_word(value(e.args[0]))});
    case Op::Select:
    case Op::FloatSelect: {
      const Id condition = value(e.args[0]), yes = value(e.args[1]), no = value(e.args[2]);
      return op(OpSelect, type_of(e.op == Op::Select ? Sort::Word : Sort::Float), {condition, yes, no});
    }
    case Op::Truncate: return op(OpConvertFToU, word_type(), {value(e.args[0])});
    case Op::ToFloat: return op(OpConvertUToF, w_.float_type(), {value(e.args[0])});
    case Op::Not: return op(OpLogicalNot, w_.bool_type(), {value(e.args[0])});
    default: return binary(e);
  }
}

void FunctionWriter::leave_function(Id result) {
  if (is_entry_) {
    store(chain(spv::StorageClass::StorageBuffer, ids_.results, {w_.word(0), lane_}), result);
    end(OpReturn, {});
  } else {
    end(OpReturnValue, {result});
  }
}

BlockCode* FunctionWriter::exit_target(Kind kind, const Targets& t) {
  switch (kind) {
    case Kind::Break: return t.nearest_merge;
    case Kind::Continue: return t.loop_continue;
    case Kind::LoopBreak: return t.loop_merge;
    case Kind::Leave: return t.leave;
    case Kind::NextCase: return t.next_case;
    default: return nullptr;
  }
}

void FunctionWriter::list(const std::vector<Stmt>& stmts, const Targets& targets) {
  for (const Stmt& s : stmts) {
    if (here_->is_closed) return;
    statement(s, targets);
  }
}

void FunctionWriter::statement(const Stmt& s, const Targets& targets) {
  switch (s.kind) {
    case Kind::Assign: return set(s.value, value(s.args[0]));
    case Kind::Trace: {
      const Id mixed = op(OpBitwiseXor, word_type(), {get(0), value(s.args[0])});
      return set(0, op(OpIAdd, word_type(), {op(OpIMul, word_type(), {mixed, w_.word(2654435761u)}), w_.word(s.value)}));
    }
    case Kind::SetElement: {
      const Id index = masked(value(s.args[0]), kElements - 1), what = value(s.args[1]);
      return store(chain(spv::StorageClass::Function, elements_, {index}), what);
    }
    case Kind::SetOwn: {
      const Id index = value(s.args[0]), what = value(s.args[1]);
      return store(own_word(index), what);
    }
    case Kind::If: return branch_statement(s, targets);
    case Kind::Loop: return s.style == Style::Single ? single_block_loop(s) : loop(s, targets);
    case Kind::Switch: return choice(s, targets);
    case Kind::Call: {
      const Id x = value(s.args[0]), y = value(s.args[1]);
      return set(s.value, op(OpFunctionCall, word_type(), {ids_.functions[s.other], x, y}));
    }
    case Kind::Exchange: return exchange(s);
    case Kind::Return: return leave_function(op(OpBitwiseXor, word_type(), {get(0), value(s.args[0])}));
    default:
      if (BlockCode* to = exit_target(s.kind, targets)) branch(to);  // none: the minimiser took its construct away
      return;
  }
}

void FunctionWriter::exchange(const Stmt& s) {
  const auto barrier = [&] {
    const auto semantics = uint32_t(spv::MemorySemanticsMask::AcquireRelease) | uint32_t(spv::MemorySemanticsMask::WorkgroupMemory);
    const Id scope = w_.word(uint32_t(spv::Scope::Workgroup));
    append(here_->code, OpControlBarrier, {scope, scope, w_.word(semantics)});
  };
  const Id vector = w_.declare(OpTypeVector, {word_type(), 3});
  const Id local = op(OpCompositeExtract, word_type(), {op(OpLoad, vector, {ids_.local_id}), 0});
  store(chain(spv::StorageClass::Workgroup, ids_.slots, {local}), get(0));
  barrier();
  const Id other = op(OpUMod, word_type(), {op(OpIAdd, word_type(), {local, w_.word(s.value)}), w_.word(program_.group)});
  set(1, op(OpBitwiseXor, word_type(), {get(1), load_from(spv::StorageClass::Workgroup, ids_.slots, {other})}));
  set(0, op(OpIAdd, word_type(), {op(OpIMul, word_type(), {get(0), w_.word(31)}), get(1)}));
  barrier();
}

void FunctionWriter::branch_statement(const Stmt& s, Targets targets) {
  const Id condition = value(s.args[0]);
  if (s.bare && s.bodies[0].size() == 1) {
    if (BlockCode* to = exit_target(s.bodies[0][0].kind, targets)) {
      BlockCode* next = new_block();
      branch_if(condition, to, next);
      return begin(next);
    }
  }
  BlockCode *yes = new_block(), *end_of_if = new_block();
  BlockCode* no = s.bodies[1].empty() ? end_of_if : new_block();
  merge(end_of_if);
  branch_if(condition, yes, no);
  targets.leave = end_of_if;
  targets.next_case = nullptr;
  begin(yes);
  list(s.bodies[0], targets);
  branch(end_of_if);
  if (no != end_of_if) {
    begin(no);
    list(s.bodies[1], targets);
    branch(end_of_if);
  }
  begin_merge(end_of_if, s.dead);
}

void FunctionWriter::choice(const Stmt& s, Targets targets) {
  const Id selector = masked(value(s.args[0]), 7);
  BlockCode* end_of_switch = new_block();
  std::vector<BlockCode*> cases;
  for (size_t c = 0; c < s.bodies.size(); ++c) cases.push_back(new_block());
  BlockCode* otherwise = s.default_case >= 0 && s.default_case < int(cases.size()) ? cases[size_t(s.default_case)] : end_of_switch;
  Words operands{selector, otherwise->label};
  edge(otherwise);
  for (size_t c = 0; c < cases.size(); ++c)
    for (uint32_t label : s.labels[c]) {
      operands.insert(operands.end(), {label, cases[c]->label});
      edge(cases[c]);
    }
  merge(end_of_switch);
  end(OpSwitch, operands);
  targets.nearest_merge = end_of_switch;
  targets.leave = nullptr;
  for (size_t c = 0; c < cases.size(); ++c) {
    targets.next_case = c + 1 < cases.size() ? cases[c + 1] : nullptr;
    begin(cases[c]);
    list(s.bodies[c], targets);
    branch(s.falls[c] && targets.next_case ? targets.next_case : end_of_switch);
  }
  begin_merge(end_of_switch, s.dead);
}

// counter < (bound & 3) + 1 and the condition
Id FunctionWriter::goes_on(const Stmt& s) {
  const Id bound = op(OpIAdd, word_type(), {masked(value(s.args[0]), 3), w_.word(1)});
  const Id in_bound = op(OpULessThan, w_.bool_type(), {get(s.value), bound});
  return op(OpLogicalAnd, w_.bool_type(), {in_bound, value(s.args[1])});
}

void FunctionWriter::single_block_loop(const Stmt& s) {
  BlockCode *header = new_block(false), *merge_block = new_block();
  set(s.value, w_.word(0));
  branch(header);
  begin(header);
  list(s.bodies[0], {});
  count(s.value);
  const Id again = goes_on(s);
  loop_merge(merge_block, header);
  branch_if(again, header, merge_block);
  seal(header);
  begin(merge_block);
}

void FunctionWriter::loop(const Stmt& s, Targets targets) {
  BlockCode *header = new_block(false), *body = new_block(), *target = new_block(), *merge_block = new_block();
  set(s.value, w_.word(0));
  branch(header);
  begin(header);
  targets.loop_merge = targets.nearest_merge = merge_block;
  targets.loop_continue = target;
  targets.leave = targets.next_case = nullptr;
  switch (s.style) {
    case Style::HeaderTest: {
      const Id go_on = goes_on(s);
      loop_merge(merge_block, target);
      branch_if(go_on, body, merge_block);
      break;
    }
    case Style::SkipFirst: {
      const Id skip = value(s.args[1]);
      loop_merge(merge_block, target);
      branch_if(skip, target, body);
      break;
    }
    case Style::While: {
      BlockCode* test = new_block();
      loop_merge(merge_block, target);
      branch(test);
      begin(test);
      branch_if(goes_on(s), body, merge_block);
      break;
    }
    default:
      loop_merge(merge_block, target);
      branch(body);
      break;
  }
  begin(body);
  if (s.style == Style::Endless) {
    BlockCode* rest = new_block();
    const Id over = op(OpUGreaterThan, w_.bool_type(), {get(s.value), masked(value(s.args[0]), 3)});
    branch_if(over, merge_block, rest);
    begin(rest);
  }
  list(s.bodies[0], targets);
  branch(target);
  begin(target);
  count(s.value);
  list(s.bodies[1], {});
  if (s.style == Style::DoWhile || s.style == Style::SkipFirst)
    branch_if(goes_on(s), header, merge_block);
  else
    branch(header);
  seal(header);
  begin_merge(merge_block, s.dead);
}

Id FunctionWriter::run() {
  const Id result = is_entry_ ? w_.void_type() : word_type();
  Words signature{result};
  if (!is_entry_) signature.insert(signature.end(), {word_type(), word_type()});
  const Id type = w_.declare(OpTypeFunction, signature), id = w_.new_id();
  append(w_.code, OpFunction, {result, id, 0, type});
  std::vector<Id> parameters;
  if (!is_entry_)
    for (int i = 0; i < 2; ++i) {
      parameters.push_back(w_.new_id());
      append(w_.code, OpFunctionParameter, {word_type(), parameters.back()});
    }
  begin(new_block());
  const auto local_variable = [&](Id pointee) { return op(OpVariable, w_.pointer_to(spv::StorageClass::Function, pointee), {uint32_t(spv::StorageClass::Function)}); };
  elements_ = local_variable(w_.array_of_words(kElements));
  for (size_t v = 0; v < tree_.variables.size(); ++v) memory_.push_back(tree_.in_memory[v] ? local_variable(type_of(tree_.variables[v])) : 0);
  const Id vector = w_.declare(OpTypeVector, {word_type(), 3});
  lane_ = op(OpCompositeExtract, word_type(), {op(OpLoad, vector, {ids_.global_id}), 0});
  for (uint32_t i = 0; i < kElements; ++i) store(chain(spv::StorageClass::Function, elements_, {w_.word(i)}), i == 0 ? lane_ : w_.word(i));
  for (uint32_t v = 0; v < tree_.variables.size(); ++v) switch (tree_.variables[v]) {
      case Sort::Word: set(v, !is_entry_ && (v == 1 || v == 2) ? parameters[v - 1] : w_.word(v)); break;
      case Sort::Bool: set(v, w_.truth(false)); break;
      case Sort::Float: set(v, w_.declare(OpConstant, {w_.float_type(), 0x3f80'0000}, true)); break;
    }
  list(tree_.body, {});
  if (!here_->is_closed) leave_function(get(0));
  for (const BlockCode* block : order_) {
    append(w_.code, OpLabel, {block->label});
    for (const Phi& phi : block->phis) {
      Words operands{type_of(tree_.variables[phi.variable]), phi.id};
      operands.insert(operands.end(), phi.operands.begin(), phi.operands.end());
      append(w_.code, OpPhi, operands);
    }
    w_.code.insert(w_.code.end(), block->code.begin(), block->code.end());
  }
  append(w_.code, OpFunctionEnd, {});
  return id;
}

bool has_exchange(const std::vector<Stmt>& list) {
  return std::any_of(list.begin(), list.end(), [](const Stmt& s) {
    return s.kind == Kind::Exchange || std::any_of(s.bodies.begin(), s.bodies.end(), has_exchange);
  });
}

}  // namespace

std::vector<uint32_t> to_spirv(const ProgramTree& program) {
  SpirvWriter writer;
  const Id vector = writer.declare(OpTypeVector, {writer.int_type(), 3});
  ModuleIds ids{};
  ids.inputs = writer.buffer_of_words(kInputBinding);
  ids.results = writer.buffer_of_words(kResultBinding);
  ids.own = writer.buffer_of_words(kOwnBinding);
  ids.global_id = writer.input(spv::BuiltIn::GlobalInvocationId, vector);
  if (has_exchange(program.functions.back().body)) {
    ids.local_id = writer.input(spv::BuiltIn::LocalInvocationId, vector);
    ids.slots = writer.variable(spv::StorageClass::Workgroup, writer.array_of_words(program.group));
  }
  for (size_t f = 0; f < program.functions.size(); ++f) ids.functions.push_back(FunctionWriter(writer, ids, program, f).run());
  return writer.assemble(ids.functions.back(), program.group, 0, {spv::Capability::Shader});
}

}  // namespace glint::test::torture
