// Reads a module's words: types, constants, variables, and the code of each function.
// SPDX-License-Identifier: Apache-2.0
#include "tests/torture/interpreter.h"

#include <fmt/format.h>
#include <stdexcept>

namespace glint::test::torture {

using enum spv::Op;

namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error("interpreter: " + what);
}

constexpr uint32_t kHeaderWords = 5;

// Returns which of the first operands are the result's type and the result.
bool has_result(spv::Op op, bool* has_type) {
  bool has = false;
  spv::HasResultAndType(op, &has, has_type);  // of the header, with SPV_ENABLE_UTILITY_CODE
  return has;
}

}  // namespace

Interpreter::Interpreter(const std::vector<uint32_t>& words) {
  decode(words);
  if (entry_ == 0) fail("no entry point");
  for (size_t axis = 0; axis < local_size_ids_.size(); ++axis)
    local_size_[axis] = uint32_t(constants_.at(local_size_ids_[axis]).part[0]);
  check_layout();
}

void Interpreter::decode(const std::vector<uint32_t>& words) {
  if (words.size() < kHeaderWords || words[0] != spv::MagicNumber) fail("no SPIR-V");
  bound_ = words[3];
  constants_.resize(bound_);
  type_of_.resize(bound_);
  FunctionCode* function = nullptr;
  for (size_t i = kHeaderWords; i < words.size();) {
    const uint32_t length = words[i] >> 16;
    Decoded inst{spv::Op(words[i] & 0xffff), 0, 0, {}};
    if (length == 0 || i + length > words.size()) fail("an instruction that does not fit");
    size_t next = i + 1;
    bool has_type = false;
    const bool has = has_result(inst.op, &has_type);
    if (has_type) inst.type = words[next++];
    if (has) inst.result = words[next++];
    inst.operands.assign(words.begin() + long(next), words.begin() + long(i + length));
    i += length;
    if (inst.result != 0 && inst.type != 0) type_of_.at(inst.result) = inst.type;
    if (inst.op == OpFunction) {
      function = &functions_[inst.result];
      function->type = inst.type;
    } else if (inst.op == OpFunctionEnd) {
      function = nullptr;
    } else if (function == nullptr) {
      declare(inst);
    } else if (inst.op == OpFunctionParameter) {
      function->parameters.push_back(inst.result);
    } else if (inst.op != OpLine && inst.op != OpNoLine && inst.op != OpSelectionMerge &&
               inst.op != OpLoopMerge) {
      if (inst.op == OpLabel) function->at_label[inst.result] = uint32_t(function->code.size());
      function->code.push_back(std::move(inst));
    }
  }
}

void Interpreter::declare(const Decoded& inst) {
  const auto& o = inst.operands;
  switch (inst.op) {
    case OpExtInstImport:
      if (o[0] == 0x4c53'4c47) glsl_ = inst.result;  // "GLSL"
      break;
    case OpEntryPoint:
      entry_ = o[1];
      break;
    case OpExecutionMode:
      if (spv::ExecutionMode(o[1]) == spv::ExecutionMode::LocalSize) local_size_ = {o[2], o[3], o[4]};
      break;
    case OpExecutionModeId:
      if (spv::ExecutionMode(o[1]) == spv::ExecutionMode::LocalSizeId)
        local_size_ids_ = {o.begin() + 2, o.end()};
      break;
    case OpDecorate:
      if (spv::Decoration(o[1]) == spv::Decoration::Binding) binding_of_[o[0]] = o[2];
      if (spv::Decoration(o[1]) == spv::Decoration::BuiltIn) builtin_of_[o[0]] = spv::BuiltIn(o[2]);
      if (spv::Decoration(o[1]) == spv::Decoration::ArrayStride) array_stride_[o[0]] = o[2];
      break;
    case OpMemberDecorate:
      if (spv::Decoration(o[2]) == spv::Decoration::Offset) member_offset_[{o[0], o[1]}] = o[3];
      break;
    case OpVariable:
      globals_.push_back({inst.result, inst.type, spv::StorageClass(o[0]), o.size() > 1 ? o[1] : 0});
      break;
    default:
      declare_type(inst);
      declare_constant(inst);
      break;
  }
}

void Interpreter::declare_type(const Decoded& inst) {
  const auto& o = inst.operands;
  TypeInfo type;
  type.op = inst.op;
  const auto repeat = [&](Id element, uint32_t count) {
    type.element = element;
    type.count = count;
    type.scalar = types_.at(element).scalar;
    type.scalars = types_.at(element).scalars * count;
  };
  switch (inst.op) {
    case OpTypeVoid:
    case OpTypeFunction:
      break;
    case OpTypeBool:
      type.scalar = {Scalar::Kind::Bool, 1};
      type.scalars = 1;
      break;
    case OpTypeInt:
    case OpTypeFloat:
      type.scalar = {inst.op == OpTypeInt ? Scalar::Kind::Int : Scalar::Kind::Float, o[0]};
      type.scalars = 1;
      break;
    case OpTypeVector:
    case OpTypeMatrix:
      repeat(o[0], o[1]);
      break;
    case OpTypeArray:
      repeat(o[0], uint32_t(constants_.at(o[1]).part[0]));
      break;
    case OpTypeRuntimeArray:
      repeat(o[0], 0);
      break;
    case OpTypeStruct:
      type.members = o;
      for (Id member : o) type.scalars += types_.at(member).scalars;
      if (!o.empty()) type.scalar = types_.at(o[0]).scalar;
      break;
    case OpTypePointer:
      type.element = o[1];
      type.scalars = 2;
      break;
    default:
      return;
  }
  types_[inst.result] = type;
}

void Interpreter::declare_constant(const Decoded& inst) {
  const auto& o = inst.operands;
  Value value;
  switch (inst.op) {
    case OpConstantTrue:
    case OpConstantFalse:
      value.count = 1;
      value.part[0] = inst.op == OpConstantTrue;
      break;
    case OpConstant:
      value.count = 1;
      value.part[0] =
          cut(o.size() > 1 ? uint64_t(o[1]) << 32 | o[0] : o[0], types_.at(inst.type).scalar.width);
      break;
    case OpConstantComposite:
      for (Id part : o)
        for (uint32_t i = 0; i < constants_.at(part).count; ++i)
          value.part.at(value.count++) = constants_[part].part[i];
      break;
    case OpConstantNull:
    case OpUndef:
      value.count = types_.at(inst.type).scalars;
      if (value.count > Value::kMost) fail("a constant of many parts");
      break;
    default:
      return;
  }
  constants_.at(inst.result) = value;
}

// Checks that buffers are dense arrays of words, so that a scalar's number is its word's.
void Interpreter::check_layout() const {
  for (const auto& [id, stride] : array_stride_)
    if (types_.count(id) && stride != 4 * types_.at(types_.at(id).element).scalars)
      fail("an array that is not dense");
  for (const auto& [member, offset] : member_offset_) {
    Id type = member.first;
    if (offset != 4 * first_scalar(&type, member.second)) fail("a struct that is not dense");
  }
}

uint32_t Interpreter::first_scalar(Id* type, uint32_t index) const {
  const TypeInfo& info = types_.at(*type);
  if (info.op == OpTypeStruct) {
    uint32_t first = 0;
    for (uint32_t i = 0; i < index; ++i) first += types_.at(info.members.at(i)).scalars;
    *type = info.members.at(index);
    return first;
  }
  if (info.op != OpTypeRuntimeArray && index >= info.count)
    fail(fmt::format("element {} of {}", index, info.count));
  *type = info.element;
  return index * types_.at(info.element).scalars;
}

}  // namespace glint::test::torture
