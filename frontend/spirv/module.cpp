// Parses SPIR-V words into a Module (SPIR-V specification, chapter 2.4, Logical Layout of a Module).
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/module.h"

#include <fmt/format.h>
#include <set>
#include <span>

#include "base/check.h"
#include "base/diagnostics.h"
#include "frontend/spirv/known_positions.h"
#include "frontend/spirv/source_lines.h"
#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

std::string string_at(std::span<const uint32_t> words, size_t* used = nullptr) {
  std::string text;
  for (size_t i = 0; i < words.size(); ++i)
    for (int byte = 0; byte < 4; ++byte) {
      const char c = char(words[i] >> (8 * byte) & 0xff);
      if (c == 0) {
        if (used) *used = i + 1;
        return text;
      }
      text += c;
    }
  if (used) *used = words.size();
  return text;
}

class Parser {
 public:
  Parser(const std::vector<uint32_t>& words, std::string name) : words_(words), name_(std::move(name)) {}

  Module run() {
    if (words_.size() < kHeaderWords || words_[0] != spv::MagicNumber) malformed("no SPIR-V header");
    module_.version = words_[1];
    module_.bound = words_[3];
    for (size_t i = kHeaderWords; i < words_.size();) {
      const size_t length = words_[i] >> 16;
      if (length == 0 || i + length > words_.size())
        malformed(fmt::format("instruction at word {} runs past the end", i));
      instruction(std::span(words_).subspan(i, length));
      i += length;
    }
    for (const auto& [mode, operands] : size_ids_) apply_local_size_id(mode, operands);
    apply_workgroup_size();
    module_.files = std::move(source_.files);
    module_.lines = std::move(source_.lines);
    module_.scopes = std::move(source_.scopes);
    return std::move(module_);
  }

 private:
  [[noreturn]] void malformed(const std::string& what) const {
    throw UserError({name_, 0, 0}, "malformed SPIR-V: " + what);
  }

  void instruction(std::span<const uint32_t> words);
  void debug(spv::Op op, std::span<const uint32_t> args);
  void mode(const Instruction& inst);
  void apply_local_size_id(Id function, const std::vector<uint32_t>& ids);
  void apply_workgroup_size();
  uint32_t width_of(Id value) const;
  void decorate(std::span<const uint32_t> args);
  void decorate_member(std::span<const uint32_t> args);
  void enter(const std::vector<uint32_t>& args);
  void declare(const Instruction& inst);
  bool declare_type(const Instruction& inst);
  bool declare_composite(const Instruction& inst, Type& type);
  void in_function(Instruction inst);
  void check_labels() const;

  const std::vector<uint32_t>& words_;
  std::string name_;
  Module module_;
  Function* function_ = nullptr;
  SourceLines source_;
  std::map<Id, Id> type_of_;
  std::vector<std::pair<Id, std::vector<uint32_t>>> size_ids_;
};

void Parser::instruction(std::span<const uint32_t> words) {
  if (source_.read(words)) return;
  Instruction inst;
  inst.op = spv::Op(words[0] & 0xffff);
  bool has_result = false, has_type = false;
  spv::HasResultAndType(inst.op, &has_result, &has_type);
  size_t at = 1;
  if (words.size() < 1 + size_t(has_result) + size_t(has_type)) malformed("an instruction lacks its result");
  if (has_type) inst.type = words[at++];
  if (has_result) inst.result = words[at++];
  if (inst.result >= module_.bound) malformed("a result id is not below the bound");
  if (has_type && has_result) type_of_[inst.result] = inst.type;
  inst.operands.assign(words.begin() + long(at), words.end());
  switch (inst.op) {
    case spv::Op::OpString:
      module_.strings[inst.result] = string_at(words.subspan(at));
      return;
    case spv::Op::OpName:
    case spv::Op::OpMemberName:
      debug(inst.op, words.subspan(1));
      return;
    case spv::Op::OpDecorate:
      decorate(words.subspan(1));
      return;
    case spv::Op::OpMemberDecorate:
      decorate_member(words.subspan(1));
      return;
    default:
      break;
  }
  inst.line = source_.line();
  if (function_)
    in_function(std::move(inst));
  else
    declare(inst);
}

void Parser::debug(spv::Op op, std::span<const uint32_t> args) {
  if (op == spv::Op::OpName) {
    module_.names[args[0]] = string_at(args.subspan(1));
  } else {  // OpMemberName
    auto& members = module_.types[args[0]].members;
    if (members.size() <= args[1]) members.resize(args[1] + 1);
    members[args[1]].name = string_at(args.subspan(2));
  }
}

void Parser::mode(const Instruction& inst) {
  const auto which = spv::ExecutionMode(inst.operands[1]);
  if (which == spv::ExecutionMode::LocalSize) {
    for (EntryPoint& entry : module_.entry_points)
      if (entry.function == inst.operands[0])
        for (size_t i = 0; i < 3; ++i) entry.local_size[i] = inst.operands[2 + i];
  } else if (which == spv::ExecutionMode::LocalSizeId) {
    size_ids_.push_back({inst.operands[0], {inst.operands.begin() + 2, inst.operands.end()}});
  }
}

void Parser::apply_local_size_id(Id function, const std::vector<uint32_t>& ids) {
  for (EntryPoint& entry : module_.entry_points)
    if (entry.function == function)
      for (size_t i = 0; i < 3 && i < ids.size(); ++i)
        entry.local_size[i] = module_.constant_u32(ids[i]).value_or(1);
}

// The constant decorated WorkgroupSize overrides the execution mode (SPIR-V specification 3.6, LocalSize).
void Parser::apply_workgroup_size() {
  for (const auto& [id, d] : module_.decorations) {
    const auto size = module_.constants.find(id);
    if (d.builtin != spv::BuiltIn::WorkgroupSize || size == module_.constants.end()) continue;
    for (EntryPoint& entry : module_.entry_points)
      if (entry.model == spv::ExecutionModel::GLCompute)
        apply_local_size_id(entry.function, size->second.operands);
  }
}

uint32_t Parser::width_of(Id value) const {
  const auto type = type_of_.find(value);
  if (type == type_of_.end()) return 32;
  const auto found = module_.types.find(type->second);
  return found == module_.types.end() ? 32 : found->second.width;
}

void Parser::decorate(std::span<const uint32_t> args) {
  Decorations& d = module_.decorations[args[0]];
  switch (spv::Decoration(args[1])) {
    case spv::Decoration::DescriptorSet:
      d.set = args[2];
      break;
    case spv::Decoration::Binding:
      d.binding = args[2];
      break;
    case spv::Decoration::BuiltIn:
      d.builtin = spv::BuiltIn(args[2]);
      break;
    case spv::Decoration::Location:
      if (spv::BuiltIn(args[2]) == kHitTriangleVertexPositions) d.builtin = kHitTriangleVertexPositions;
      break;
    case spv::Decoration::Volatile:
      d.is_volatile = true;
      break;
    case spv::Decoration::NoContraction:
      d.no_contraction = true;
      break;
    case spv::Decoration::Coherent:
      d.is_coherent = true;
      break;
    case spv::Decoration::ArrayStride:
      module_.types[args[0]].array_stride = args[2];
      break;
    case spv::Decoration::Block:
    case spv::Decoration::BufferBlock:
      module_.types[args[0]].is_block = true;
      module_.types[args[0]].is_buffer_block |= spv::Decoration(args[1]) == spv::Decoration::BufferBlock;
      break;
    default:
      break;  // all other decorations have no effect here: RelaxedPrecision, ...
  }
}

void Parser::decorate_member(std::span<const uint32_t> args) {
  auto& members = module_.types[args[0]].members;
  if (members.size() <= args[1]) members.resize(args[1] + 1);
  Type::Member& member = members[args[1]];
  switch (spv::Decoration(args[2])) {
    case spv::Decoration::Offset:
      member.offset = args[3];
      break;
    case spv::Decoration::MatrixStride:
      member.matrix_stride = args[3];
      break;
    case spv::Decoration::RowMajor:
      member.row_major = true;
      break;
    case spv::Decoration::Volatile:
    case spv::Decoration::Coherent:
      member.is_volatile = true;
      break;
    case spv::Decoration::BuiltIn:
      member.builtin = spv::BuiltIn(args[3]);
      break;
    default:
      break;
  }
}

void Parser::enter(const std::vector<uint32_t>& args) {
  size_t words = 0;
  EntryPoint entry{
      spv::ExecutionModel(args[0]), args[1], string_at(std::span(args).subspan(2), &words), {1, 1, 1}, {}};
  entry.interface.insert(args.begin() + 2 + long(words), args.end());
  module_.entry_points.push_back(std::move(entry));
}

void Parser::declare(const Instruction& inst) {
  const auto& args = inst.operands;
  switch (inst.op) {
    case spv::Op::OpCapability:
      module_.capabilities.push_back({spv::Capability(args[0]), inst.line});
      return;
    case spv::Op::OpExtInstImport:
      module_.imports[inst.result] = string_at(args);
      return;
    case spv::Op::OpEntryPoint:
      enter(args);
      return;
    case spv::Op::OpExecutionMode:
    case spv::Op::OpExecutionModeId:
      mode(inst);
      return;
    case spv::Op::OpVariable:
      module_.variables[inst.result] = {inst.result, inst.type, spv::StorageClass(args[0]),
                                        args.size() > 1 ? args[1] : 0, inst.line};
      return;
    case spv::Op::OpFunction:
      module_.functions.push_back({inst.result, {}});
      function_ = &module_.functions.back();
      return;
    default:
      break;
  }
  if (declare_type(inst)) return;
  if (inst.result != 0 && inst.type != 0) module_.constants[inst.result] = inst;
}

// Fills in a type that is made of other types. Returns false when the instruction declares no such type.
bool Parser::declare_composite(const Instruction& inst, Type& type) {
  using Kind = Type::Kind;
  const auto& args = inst.operands;
  switch (inst.op) {
    case spv::Op::OpTypeVector:
      type.kind = Kind::Vector, type.element = args[0], type.count = args[1];
      return true;
    case spv::Op::OpTypeMatrix:
      type.kind = Kind::Matrix, type.element = args[0], type.count = args[1];
      return true;
    case spv::Op::OpTypeArray:
      type.kind = Kind::Array, type.element = args[0], type.count = module_.constant_u32(args[1]).value_or(0);
      return true;
    case spv::Op::OpTypeRuntimeArray:
      type.kind = Kind::RuntimeArray, type.element = args[0];
      return true;
    case spv::Op::OpTypeStruct:
      type.kind = Kind::Struct;
      type.members.resize(args.size());
      for (size_t i = 0; i < args.size(); ++i) type.members[i].type = args[i];
      return true;
    case spv::Op::OpTypePointer:
      type.kind = Kind::Pointer, type.storage = spv::StorageClass(args[0]), type.element = args[1];
      return true;
    case spv::Op::OpTypeImage:
      type.kind = Kind::Image, type.element = args[0], type.dim = spv::Dim(args[1]),
      type.is_storage_image = args[5] == 2;
      type.is_arrayed = args[3] != 0, type.is_multisampled = args[4] != 0,
      type.format = spv::ImageFormat(args[6]);
      return true;
    default:
      return false;
  }
}

bool Parser::declare_type(const Instruction& inst) {
  using Kind = Type::Kind;
  const auto& args = inst.operands;
  if (inst.type != 0 || inst.result == 0) return false;
  Type& type = module_.types[inst.result];  // A decoration may have made the entry already.
  type.op = inst.op;
  type.name = module_.names.count(inst.result) ? module_.names[inst.result] : "";
  switch (inst.op) {
    case spv::Op::OpTypeVoid:
      type.kind = Kind::Void;
      break;
    case spv::Op::OpTypeBool:
      type.kind = Kind::Bool;
      break;
    case spv::Op::OpTypeInt:
      type.kind = Kind::Int, type.width = args[0], type.is_signed = args[1] != 0;
      break;
    case spv::Op::OpTypeFloat:
      type.kind = Kind::Float, type.width = args[0];
      break;
    case spv::Op::OpTypeSampler:
      type.kind = Kind::Sampler;
      break;
    case spv::Op::OpTypeSampledImage:
      type.kind = Kind::SampledImage, type.element = args[0];
      break;
    case spv::Op::OpTypeAccelerationStructureKHR:
      type.kind = Kind::AccelerationStructure;
      break;
    case spv::Op::OpTypeRayQueryKHR:
      type.kind = Kind::RayQuery;
      break;
    case spv::Op::OpTypeFunction:
      type.kind = Kind::Function;
      break;
    default:
      if (!declare_composite(inst, type)) type.kind = Kind::Other;
      break;
  }
  return true;
}

void Parser::check_labels() const {
  std::set<Id> labels;
  for (const Block& block : function_->blocks) labels.insert(block.label);
  for (const Block& block : function_->blocks) {
    if (block.code.empty()) malformed(fmt::format("block %{} is empty", block.label));
    for (Id to : block.successors())
      if (!labels.count(to))
        malformed(fmt::format("%{} is a branch target but no block of the function", to));
    if (block.merge != spv::Op::OpNop && !labels.count(block.merge_block))
      malformed("a merge block is missing");
  }
}

void Parser::in_function(Instruction inst) {
  switch (inst.op) {
    case spv::Op::OpFunctionEnd:
      check_labels();
      function_ = nullptr;
      return;
    case spv::Op::OpNop:
    case spv::Op::OpNoLine:
      return;
    case spv::Op::OpLabel:
      function_->blocks.emplace_back();
      function_->blocks.back().label = inst.result;
      return;
    default:
      break;
  }
  // Only functions that nothing calls still have parameters.
  if (inst.op == spv::Op::OpFunctionParameter) return;
  if (function_->blocks.empty()) malformed("an instruction stands before the first label of a function");
  Block& block = function_->blocks.back();
  if (inst.op == spv::Op::OpSelectionMerge || inst.op == spv::Op::OpLoopMerge) {
    block.merge = inst.op;
    block.merge_block = inst.operands[0];
    block.merge_line = inst.line;
    if (inst.op == spv::Op::OpLoopMerge) block.continue_block = inst.operands[1];
    return;
  }
  if (inst.op == spv::Op::OpSwitch && width_of(inst.operands.at(0)) == 64) inst.literal_words = 2;
  block.code.push_back(std::move(inst));
}

}  // namespace

Module Module::parse(const std::vector<uint32_t>& words, const std::string& name) {
  return Parser(words, name).run();
}

}  // namespace glint::frontend
