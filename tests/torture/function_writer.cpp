// Writes variables as phis, expressions, and statements with the constructs around them.
// SPDX-License-Identifier: Apache-2.0
#include "tests/torture/function_writer.h"

#include <cstdint>
#include <vector>

namespace glint::test::torture {

using enum spv::Op;
using Op = Expr::Op;
using Kind = Stmt::Kind;
using Style = Stmt::Style;

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
    case Op::Add:
      return op(OpIAdd, word, {a, b});
    case Op::Sub:
      return op(OpISub, word, {a, b});
    case Op::Mul:
      return op(OpIMul, word, {a, b});
    case Op::And:
      return op(OpBitwiseAnd, word, {a, b});
    case Op::Or:
      return op(OpBitwiseOr, word, {a, b});
    case Op::Xor:
      return op(OpBitwiseXor, word, {a, b});
    case Op::Shl:
      return op(OpShiftLeftLogical, word, {a, masked(b, 31)});
    case Op::Shr:
      return op(OpShiftRightLogical, word, {a, masked(b, 31)});
    case Op::Div:
    case Op::Mod:
      b = op(OpBitwiseOr, word, {b, w_.word(1)});
      return op(e.op == Op::Div ? OpUDiv : OpUMod, word, {a, b});
    case Op::Less:
      return op(OpULessThan, truth, {a, b});
    case Op::SignedLess:
      return op(OpSLessThan, truth, {a, b});
    case Op::Equal:
      return op(OpIEqual, truth, {a, b});
    case Op::FloatLess:
      return op(OpFOrdLessThan, truth, {a, b});
    case Op::Both:
      return op(OpLogicalAnd, truth, {a, b});
    case Op::Either:
      return op(OpLogicalOr, truth, {a, b});
    case Op::FloatAdd:
      return op(OpFAdd, number, {a, b});
    default:
      return op(OpFMul, number, {a, b});
  }
}

Id FunctionWriter::value(const Expr& e) {
  using Storage = spv::StorageClass;
  switch (e.op) {
    case Op::Constant:
      return w_.word(e.value);
    case Op::FloatConstant:
      return w_.declare(OpConstant, {w_.float_type(), e.value}, true);
    case Op::Variable:
    case Op::BoolVariable:
    case Op::FloatVariable:
      return get(e.value);
    case Op::Lane:
      return lane_;
    case Op::Input:
      return load_from(Storage::StorageBuffer, ids_.inputs,
                       {w_.word(0), masked(value(e.args[0]), kInputWords - 1)});
    case Op::Element:
      return load_from(Storage::Function, elements_, {masked(value(e.args[0]), kElements - 1)});
    case Op::Own:
      return op(OpLoad, word_type(), {own_word(value(e.args[0]))});
    case Op::Select:
    case Op::FloatSelect: {
      const Id condition = value(e.args[0]), yes = value(e.args[1]), no = value(e.args[2]);
      return op(OpSelect, type_of(e.op == Op::Select ? Sort::Word : Sort::Float), {condition, yes, no});
    }
    case Op::Truncate:
      return op(OpConvertFToU, word_type(), {value(e.args[0])});
    case Op::ToFloat:
      return op(OpConvertUToF, w_.float_type(), {value(e.args[0])});
    case Op::Not:
      return op(OpLogicalNot, w_.bool_type(), {value(e.args[0])});
    default:
      return binary(e);
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
    case Kind::Break:
      return t.nearest_merge;
    case Kind::Continue:
      return t.loop_continue;
    case Kind::LoopBreak:
      return t.loop_merge;
    case Kind::Leave:
      return t.leave;
    case Kind::NextCase:
      return t.next_case;
    default:
      return nullptr;
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
    case Kind::Assign:
      return set(s.value, value(s.args[0]));
    case Kind::Trace: {
      const Id mixed = op(OpBitwiseXor, word_type(), {get(0), value(s.args[0])});
      return set(0, op(OpIAdd, word_type(),
                       {op(OpIMul, word_type(), {mixed, w_.word(2654435761u)}), w_.word(s.value)}));
    }
    case Kind::SetElement: {
      const Id index = masked(value(s.args[0]), kElements - 1), what = value(s.args[1]);
      return store(chain(spv::StorageClass::Function, elements_, {index}), what);
    }
    case Kind::SetOwn: {
      const Id index = value(s.args[0]), what = value(s.args[1]);
      return store(own_word(index), what);
    }
    case Kind::If:
      return branch_statement(s, targets);
    case Kind::Loop:
      return s.style == Style::Single ? single_block_loop(s) : loop(s, targets);
    case Kind::Switch:
      return choice(s, targets);
    case Kind::Call: {
      const Id x = value(s.args[0]), y = value(s.args[1]);
      return set(s.value, op(OpFunctionCall, word_type(), {ids_.functions[s.other], x, y}));
    }
    case Kind::Exchange:
      return exchange(s);
    case Kind::Return:
      return leave_function(op(OpBitwiseXor, word_type(), {get(0), value(s.args[0])}));
    default:
      if (BlockCode* to = exit_target(s.kind, targets))
        branch(to);  // none: the minimiser took its construct away
      return;
  }
}

void FunctionWriter::exchange(const Stmt& s) {
  const auto barrier = [&] {
    const auto semantics = uint32_t(spv::MemorySemanticsMask::AcquireRelease) |
                           uint32_t(spv::MemorySemanticsMask::WorkgroupMemory);
    const Id scope = w_.word(uint32_t(spv::Scope::Workgroup));
    append(here_->code, OpControlBarrier, {scope, scope, w_.word(semantics)});
  };
  const Id vector = w_.declare(OpTypeVector, {word_type(), 3});
  const Id local = op(OpCompositeExtract, word_type(), {op(OpLoad, vector, {ids_.local_id}), 0});
  store(chain(spv::StorageClass::Workgroup, ids_.slots, {local}), get(0));
  barrier();
  const Id other =
      op(OpUMod, word_type(), {op(OpIAdd, word_type(), {local, w_.word(s.value)}), w_.word(program_.group)});
  set(1,
      op(OpBitwiseXor, word_type(), {get(1), load_from(spv::StorageClass::Workgroup, ids_.slots, {other})}));
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
  BlockCode* otherwise = s.default_case >= 0 && s.default_case < int(cases.size())
                             ? cases[size_t(s.default_case)]
                             : end_of_switch;
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

// Returns the condition `counter < (bound & 3) + 1` and the loop's own condition.
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
  BlockCode *header = new_block(false), *body = new_block(), *target = new_block(),
            *merge_block = new_block();
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

}  // namespace glint::test::torture
