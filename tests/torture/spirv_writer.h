// Puts SPIR-V modules together word by word: types and constants once each, then functions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <spirv/unified1/spirv.hpp11>
#include <vector>

namespace glint::test::torture {

using Id = uint32_t;
using Words = std::vector<uint32_t>;

inline void append(Words& to, spv::Op op, const Words& operands) {
  to.push_back(uint32_t(operands.size() + 1) << 16 | uint32_t(op));
  to.insert(to.end(), operands.begin(), operands.end());
}

class SpirvWriter {
 public:
  Words decorations, code;  // of variables; of functions

  Id new_id() { return next_++; }

  // Declares a type or constant. The same words get the same id.
  Id declare(spv::Op op, Words operands, bool is_constant = false) {
    Words key{uint32_t(op)};
    key.insert(key.end(), operands.begin(), operands.end());
    Id& id = known_[key];
    if (id) return id;
    id = new_id();
    operands.insert(operands.begin() + (is_constant ? 1 : 0), id);
    append(globals_, op, operands);
    return id;
  }
  Id void_type() { return declare(spv::Op::OpTypeVoid, {}); }
  Id bool_type() { return declare(spv::Op::OpTypeBool, {}); }
  Id int_type(uint32_t width = 32, bool is_signed = false) {
    return declare(spv::Op::OpTypeInt, {width, is_signed});
  }
  Id float_type(uint32_t width = 32) { return declare(spv::Op::OpTypeFloat, {width}); }
  Id pointer_to(spv::StorageClass storage, Id type) {
    return declare(spv::Op::OpTypePointer, {uint32_t(storage), type});
  }
  Id word(uint32_t value) { return declare(spv::Op::OpConstant, {int_type(), value}, true); }
  Id truth(bool value) {
    return declare(value ? spv::Op::OpConstantTrue : spv::Op::OpConstantFalse, {bool_type()}, true);
  }
  Id undefined(Id type) { return declare(spv::Op::OpUndef, {type}, true); }
  Id array_of_words(uint32_t count) { return declare(spv::Op::OpTypeArray, {int_type(), word(count)}); }

  void decorate(Id id, spv::Decoration what, const Words& operands = {}) {
    Words all{id, uint32_t(what)};
    all.insert(all.end(), operands.begin(), operands.end());
    append(decorations, spv::Op::OpDecorate, all);
  }
  // Declares a module-level variable, which is in the entry point's interface.
  Id variable(spv::StorageClass storage, Id type) {
    const Id pointer = pointer_to(storage, type), id = new_id();
    append(globals_, spv::Op::OpVariable, {pointer, id, uint32_t(storage)});
    interface_.push_back(id);
    return id;
  }
  // Declares struct { uint words[]; } in set 0.
  Id buffer_of_words(uint32_t binding) {
    if (!block_) {
      const Id array = new_id();
      append(globals_, spv::Op::OpTypeRuntimeArray, {array, int_type()});
      decorate(array, spv::Decoration::ArrayStride, {4});
      block_ = new_id();
      append(globals_, spv::Op::OpTypeStruct, {block_, array});
      decorate(block_, spv::Decoration::Block);
      append(decorations, spv::Op::OpMemberDecorate, {block_, 0, uint32_t(spv::Decoration::Offset), 0});
    }
    const Id id = variable(spv::StorageClass::StorageBuffer, block_);
    decorate(id, spv::Decoration::DescriptorSet, {0});
    decorate(id, spv::Decoration::Binding, {binding});
    return id;
  }
  Id input(spv::BuiltIn what, Id type) {
    const Id id = variable(spv::StorageClass::Input, type);
    decorate(id, spv::Decoration::BuiltIn, {uint32_t(what)});
    return id;
  }

  // Returns the module of a compute shader.
  Words assemble(Id entry, uint32_t local_size, Id glsl_import,
                 const std::vector<spv::Capability>& capabilities) const {
    Words words{spv::MagicNumber, 0x0001'0600, 0, next_, 0};
    for (spv::Capability c : capabilities) append(words, spv::Op::OpCapability, {uint32_t(c)});
    if (glsl_import)
      append(words, spv::Op::OpExtInstImport, {glsl_import, 0x4c53'4c47, 0x6474'732e, 0x3035'342e, 0});
    append(words, spv::Op::OpMemoryModel,
           {uint32_t(spv::AddressingModel::Logical), uint32_t(spv::MemoryModel::GLSL450)});
    Words point{uint32_t(spv::ExecutionModel::GLCompute), entry, 0x6e69'616d, 0};  // "main"
    point.insert(point.end(), interface_.begin(), interface_.end());
    append(words, spv::Op::OpEntryPoint, point);
    append(words, spv::Op::OpExecutionMode,
           {entry, uint32_t(spv::ExecutionMode::LocalSize), local_size, 1, 1});
    for (const Words* part : {&decorations, &globals_, &code})
      words.insert(words.end(), part->begin(), part->end());
    return words;
  }

 private:
  Id next_ = 1, block_ = 0;
  std::map<Words, Id> known_;
  Words globals_, interface_;
};

}  // namespace glint::test::torture
