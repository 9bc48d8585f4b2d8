// Writes a tree as SPIR-V: variables as phis where they are not in memory, and branches that no GLSL has.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tests/torture/function_writer.h"

namespace glint::test::torture {

using enum spv::Op;
using Kind = Stmt::Kind;

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
  const auto local_variable = [&](Id pointee) {
    return op(OpVariable, w_.pointer_to(spv::StorageClass::Function, pointee),
              {uint32_t(spv::StorageClass::Function)});
  };
  elements_ = local_variable(w_.array_of_words(kElements));
  for (size_t v = 0; v < tree_.variables.size(); ++v)
    memory_.push_back(tree_.in_memory[v] ? local_variable(type_of(tree_.variables[v])) : 0);
  const Id vector = w_.declare(OpTypeVector, {word_type(), 3});
  lane_ = op(OpCompositeExtract, word_type(), {op(OpLoad, vector, {ids_.global_id}), 0});
  for (uint32_t i = 0; i < kElements; ++i)
    store(chain(spv::StorageClass::Function, elements_, {w_.word(i)}), i == 0 ? lane_ : w_.word(i));
  for (uint32_t v = 0; v < tree_.variables.size(); ++v) switch (tree_.variables[v]) {
      case Sort::Word:
        if (v == 1 && is_entry_)
          set(v, lane_);
        else if (v == 2 && is_entry_)
          set(v, load_from(spv::StorageClass::StorageBuffer, ids_.inputs,
                           {w_.word(0), masked(lane_, kInputWords - 1)}));
        else
          set(v, v == 1 || v == 2 ? parameters[v - 1] : w_.word(v));
        break;
      case Sort::Bool:
        set(v, w_.truth(false));
        break;
      case Sort::Float:
        set(v, w_.declare(OpConstant, {w_.float_type(), 0x3f80'0000}, true));
        break;
    }
  list(tree_.body, {});
  if (!here_->is_closed)
    leave_function(
        op(OpBitwiseXor, word_type(),
           {get(0), op(OpIAdd, word_type(), {op(OpIMul, word_type(), {get(3), w_.word(31)}), get(4)})}));
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

namespace {

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
  for (size_t f = 0; f < program.functions.size(); ++f)
    ids.functions.push_back(FunctionWriter(writer, ids, program, f).run());
  return writer.assemble(ids.functions.back(), program.group, 0, {spv::Capability::Shader});
}

}  // namespace glint::test::torture
