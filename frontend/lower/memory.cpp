// Lowers loads and stores of whole values with as few vector accesses as their alignment allows.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <utility>

#include "frontend/lower/lowering.h"
#include "isa/descriptors.h"

namespace glint::frontend {
namespace {

std::string_view space_of(PointerSpace space) {
  switch (space) {
    case PointerSpace::Local:
      return "local";
    case PointerSpace::Shared:
      return "shared";
    case PointerSpace::Constant:
      return "const";
    default:
      return "global";
  }
}

// Returns how many consecutive 32-bit leaves from `first` on one access can move: 4, 2 or 1.
int words_together(const std::vector<Leaf>& leaves, size_t first, const Pointer& p) {
  const uint32_t alignment = std::max(p.alignment, p.known_alignment);
  const int64_t displacement = p.known_alignment > p.alignment ? 0 : p.displacement;
  for (int words : {4, 2}) {
    if (first + words > leaves.size() || alignment < 4u * words) continue;
    const int64_t at = displacement + leaves[first].offset;
    bool fits = at % (4 * words) == 0;
    for (int i = 0; fits && i < words; ++i)
      fits =
          bytes_of(leaves[first + i].part) == 4 && leaves[first + i].offset == leaves[first].offset + 4 * i;
    if (fits) return words;
  }
  return 1;
}

// Returns the end of the op's name for `words` leaves like this one. Loads of narrow values fill the bits
// above with zeros.
std::string_view shape_of(Part part, int words, bool is_load) {
  switch (bytes_of(part)) {
    case 1:
      return is_load ? "u8" : "b8";
    case 2:
      return is_load ? "u16" : "b16";
    case 8:
      return "b64";
    default:
      return words == 4 ? "v4.b32" : words == 2 ? "v2.b32" : "b32";
  }
}

Operands slice(ModuleLowering& l, const Pointer& p, const Operands& parts) {
  const uint32_t count = l.layout().num_parts(p.type);
  Operands result;
  for (uint32_t i = 0; i < count; ++i) {
    const size_t first = size_t(p.displacement) + i;
    Operand part = parts.at(first);
    if (!is_constant(p.part_index, 0))
      for (uint32_t at = 1; first + at < parts.size(); ++at)
        part = l.emit().select(l.emit().value("setp.eq.u32", {p.part_index, Operand::value(at)}),
                               parts[first + at], part);
    result.push_back(part);
  }
  return result;
}

// Returns the address of a descriptor in an array. Arrays of buffers and of acceleration structures have
// their descriptors in a table in global memory (docs/abi.md).
Operand descriptor_in_table(ModuleLowering& l, const Operand& table, const Operand& index) {
  return l.emit().value("mad.wide.u32", {index, Operand::value(isa::kDescriptorBytes), table});
}

Operands load_resource(ModuleLowering& l, const Pointer& p) {
  const Decorations& d = l.decorations(p.variable);
  const int32_t at = int32_t(isa::descriptor_offset(d.set.value_or(0), d.binding.value_or(0)));
  const Type::Kind kind = l.module().type(p.type).kind;
  const Id declared = l.module().type(l.module().variables.at(p.variable).type).element;
  if (kind == Type::Kind::AccelerationStructure) {
    const Operand found = l.emit().load("ld.const.b64", Operand::value(0), at, 1, 1)[0];
    if (declared == p.type) return {found};
    return l.emit().load("ld.global.b64", descriptor_in_table(l, found, p.base), 0, 1, 1);
  }
  // The images of an array have consecutive handles.
  const Operand first = l.emit().load("ld.const.b32", Operand::value(0), at, 1, 1)[0];
  const Operand number = l.emit().value("add.u32", {first, p.base});
  if (kind != Type::Kind::Sampler) return {number};
  const Operand field = l.emit().value("add.u32", {number, Operand::value(1)});
  return {l.emit().value("shl.b32", {field, Operand::value(uint32_t(isa::kHandleSamplerShift))})};
}

}  // namespace

Pointer in_reach(ModuleLowering& l, Pointer p) {
  constexpr int64_t kReach = int64_t(1) << 30;
  if (p.displacement > -kReach && p.displacement < kReach) return p;
  if (p.space == PointerSpace::Global)
    p.base = l.emit().value("add.u64", {p.base, Operand::value(uint64_t(p.displacement))});
  else
    p.base = l.emit().value("add.u32", {p.base, Operand::value(uint32_t(p.displacement))});
  p.displacement = 0;
  p.alignment = 4;
  p.known_alignment = 0;
  return p;
}

Operands ModuleLowering::load(const Pointer& pointer) {
  switch (pointer.space) {
    case PointerSpace::RayQuery:
      unsupported("a ray query as a value");
      [[fallthrough]];
    case PointerSpace::Nowhere:
      return Operands(layout_.num_parts(pointer.type), Operand::value(0));
    case PointerSpace::Builtin: {
      const Variable& variable = module_.variables.at(pointer.variable);
      return slice(*this, pointer,
                   load_builtin(*decorations(variable.id).builtin, module_.type(variable.type).element));
    }
    case PointerSpace::AttributePair: {
      const Id type = module_.type(module_.variables.at(pointer.variable).type).element;
      Operands all{Operand::of(isa::Special::HitU), Operand::of(isa::Special::HitV)};
      for (size_t i = all.size(); i < size_t(layout_.num_parts(type)); ++i)
        all.push_back(emitter_.load("ld.local.b32", Operand::of(isa::Special::Attribute), int32_t(4 * i), 1,
                                    version_of(PointerSpace::Local))[0]);
      return slice(*this, pointer, all);
    }
    case PointerSpace::Resource:
      return load_resource(*this, pointer);
    case PointerSpace::Texel:
      unsupported("a texel's pointer used by other than atomics");
      return Operands(layout_.num_parts(pointer.type), Operand::value(0));
    case PointerSpace::Local:
    case PointerSpace::Global:
    case PointerSpace::Shared:
    case PointerSpace::Constant:
      break;
  }
  const Pointer p = in_reach(*this, pointer);
  const std::vector<Leaf> leaves = layout_.leaves(p.type, p.matrix, p.component_stride);
  const uint64_t version = p.is_volatile ? 0 : p.is_constant ? 1 : version_of(p.space);
  Operands result;
  for (size_t i = 0; i < leaves.size();) {
    const int words = words_together(leaves, i, p);
    const std::string_view shape = shape_of(leaves[i].part, words, true);
    const Operands parts = emitter_.load(fmt::format("ld.{}.{}", space_of(p.space), shape), p.base,
                                         int32_t(p.displacement + leaves[i].offset), words, version);
    for (int w = 0; w < words; ++w) {
      const bool is_bool = leaves[i + w].part == Part::Bool;
      result.push_back(is_bool ? emitter_.value("setp.ne.u32", {parts[w], Operand::value(0)}) : parts[w]);
    }
    i += size_t(words);
  }
  return result;
}

void ModuleLowering::store(const Pointer& pointer, const Operands& parts) {
  if (pointer.space == PointerSpace::Nowhere) return;
  if (pointer.space != PointerSpace::Local && pointer.space != PointerSpace::Global &&
      pointer.space != PointerSpace::Shared)
    return unsupported("OpStore to this kind of variable");
  const Pointer p = in_reach(*this, pointer);
  note_store(p.space);
  const uint64_t version = version_of(p.space);
  const std::vector<Leaf> leaves = layout_.leaves(p.type, p.matrix, p.component_stride);
  for (size_t i = 0; i < leaves.size();) {
    const int words = words_together(leaves, i, p);
    const std::string_view shape = shape_of(leaves[i].part, words, false);
    Operands operands{p.base};
    for (int w = 0; w < words; ++w) {
      const Operand& part = parts.at(i + size_t(w));
      const bool is_bool = leaves[i + w].part == Part::Bool;
      operands.push_back(is_bool ? emitter_.value("selp.b32", {Operand::value(1), Operand::value(0), part})
                                 : part);
    }
    const int32_t at = int32_t(p.displacement + leaves[i].offset);
    for (int w = 0; bytes_of(leaves[i].part) == 4 && !p.is_volatile && w < words; ++w)
      emitter_.remember(fmt::format("ld.{}.b32", space_of(p.space)), p.base, at + 4 * w, version,
                        operands[1 + w]);
    emitter_.effect(fmt::format("st.{}.{}", space_of(p.space), shape), std::move(operands), at);
    i += size_t(words);
  }
}

uint64_t& ModuleLowering::version_of(PointerSpace space) {
  return space == PointerSpace::Local    ? local_version_
         : space == PointerSpace::Shared ? shared_version_
                                         : global_version_;
}

void ModuleLowering::note_store(PointerSpace space) {
  ++version_of(space);
}

Operand ModuleLowering::buffer_entry(const Pointer& p) {
  if (p.table.kind != Operand::Kind::None) return descriptor_in_table(*this, p.table, p.base);
  const Decorations& d = decorations(p.variable);
  const uint32_t at = isa::descriptor_offset(d.set.value_or(0), d.binding.value_or(0));
  return descriptor_in_table(*this, emitter_.load("ld.const.b64", Operand::value(0), int32_t(at), 1, 1)[0],
                             p.base);
}

Pointer ModuleLowering::buffer_element(Pointer p) {
  p.entry = buffer_entry(p);
  p.base = emitter_.load("ld.global.b64", p.entry, 0, 1, 1)[0];
  p.space = PointerSpace::Global;
  return p;
}

uint32_t ModuleLowering::shared_offset(Id variable) {
  if (const auto it = shared_.find(variable); it != shared_.end()) return it->second;
  const Id type = module_.type(type_of(variable)).element;
  // With SPV_KHR_workgroup_memory_explicit_layout, all blocks begin at the same place.
  const bool is_block = module_.type(type).is_block;
  constexpr uint32_t kAlign = 16;
  const uint32_t at = is_block ? 0 : (program_.shared_bytes + kAlign - 1) / kAlign * kAlign;
  program_.shared_bytes = std::max(program_.shared_bytes, at + layout_.size(type));
  return shared_[variable] = at;
}

uint32_t ModuleLowering::local_offset(Id variable) {
  if (const auto it = frame_.find(variable); it != frame_.end()) return it->second;
  constexpr uint32_t kAlign = 16;  // lets one access move a vector of four words
  const uint32_t at = (program_.local_bytes + kAlign - 1) / kAlign * kAlign;
  program_.local_bytes = at + layout_.size(module_.type(type_of(variable)).element);
  if (program_.local_bytes > kMostLocalBytes) {
    unsupported(fmt::format("the variables take more than {} bytes of every thread", kMostLocalBytes));
    program_.local_bytes = at;  // It cannot overflow, and more variables are looked at.
  }
  const auto global = module_.variables.find(variable);
  if (global != module_.variables.end() && global->second.storage == spv::StorageClass::HitObjectAttributeNV)
    program_.local_bytes = at + 64;  // ho.attributes stores all 64 bytes (docs/abi.md).
  return frame_[variable] = at;
}

uint32_t ModuleLowering::attribute_buffers() {
  if (attribute_buffers_ != 0xffff'ffff) return attribute_buffers_;
  constexpr uint32_t kTwoBuffers = 2 * 64;  // docs/abi.md, Calls and rays
  attribute_buffers_ = (program_.local_bytes + 15) / 16 * 16;
  program_.local_bytes = attribute_buffers_ + kTwoBuffers;
  return attribute_buffers_;
}

}  // namespace glint::frontend
