// Lowers pointers: variables, access chains, and the ops that read and write through them.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <fmt/format.h>

#include "frontend/lower/lowering.h"
#include "frontend/spirv/spirv.h"
#include "isa/descriptors.h"

namespace glint::frontend {

Pointer ModuleLowering::buffer_pointer(const Variable& variable, Pointer p) {
  const Decorations& d = decorations(variable.id);
  const uint32_t descriptor = isa::descriptor_offset(d.set.value_or(0), d.binding.value_or(0));
  // Choice: buffers are bound at multiples of 16 bytes (Vulkan minStorageBufferOffsetAlignment).
  p.alignment = 16;
  const Type* block = &module_.type(p.type);
  while (block->kind == Type::Kind::Array || block->kind == Type::Kind::RuntimeArray)
    block = &module_.type(block->element);
  p.is_constant = variable.storage == spv::StorageClass::Uniform && !block->is_buffer_block;
  if (block != &module_.type(p.type)) {
    p.space = PointerSpace::Resource;
    return p;
  }
  p.space = PointerSpace::Global;
  p.base = emitter_.load("ld.const.b64", Operand::value(0), int32_t(descriptor), 1, 1)[0];
  return p;
}

namespace {

// Returns true for types of objects that are held in machine state, not in memory, and are named by an index.
bool is_numbered(const Module& module, Id type) {
  while (module.type(type).kind == Type::Kind::Array) type = module.type(type).element;
  return module.type(type).kind == Type::Kind::RayQuery || module.type(type).op == spv::Op::OpTypeHitObjectNV;
}

}  // namespace

// Returns the pointer of a variable that connects a shader with the one that called it or with its record.
Pointer ModuleLowering::interface_pointer(const Variable& variable, Pointer p) {
  using Storage = spv::StorageClass;
  if (variable.storage == Storage::ShaderRecordBufferKHR) {
    p.space = PointerSpace::Global;
    p.base =
        emitter_.value("pack.b64", {Operand::of(isa::Special::Record), Operand::of(isa::Special::RecordHi)});
    p.is_constant = true;  // In Vulkan, shaders only read the shader record.
    return p;
  }
  if (variable.storage == Storage::HitAttributeKHR) {
    // Choice: a triangle's weights also reach shaders that declare three floats, as on hardware.
    const std::vector<Part> parts = layout_.parts(p.type);
    const bool is_pair =
        parts.size() >= 2 && parts.size() <= 3 &&
        std::all_of(parts.begin(), parts.end(), [](Part part) { return part == Part::Float32; });
    p.space =
        is_pair && stage() != isa::Stage::Intersection ? PointerSpace::AttributePair : PointerSpace::Local;
    p.base = attributes_in_frame_ ? Operand::stack_pointer() : Operand::of(isa::Special::Attribute);
    if (attributes_in_frame_) p.displacement = local_offset(variable.id);
    return p;
  }
  p.space = PointerSpace::Local;
  p.base = Operand::of(isa::Special::Payload);
  return p;
}

Pointer ModuleLowering::variable_pointer(const Variable& variable) {
  using Storage = spv::StorageClass;
  Pointer p;
  p.type = module_.type(variable.type).element;
  p.variable = variable.id;
  if (is_numbered(module_, p.type)) {
    p.space = PointerSpace::RayQuery;
    p.base = Operand::value(ray_query(variable.id));
    return p;
  }
  const Decorations& d = decorations(variable.id);
  p.is_volatile = d.is_volatile || d.is_coherent;
  if (d.set.value_or(0) >= isa::kMaxSets || d.binding.value_or(0) >= isa::kMaxBindings)
    unsupported(fmt::format("descriptor set {} binding {}", d.set.value_or(0), d.binding.value_or(0)),
                variable.line);
  switch (variable.storage) {
    case Storage::Function:
    case Storage::Private:
    case Storage::RayPayloadKHR:
    case Storage::CallableDataKHR:
    case Storage::HitObjectAttributeNV:
      p.space = PointerSpace::Local;
      p.base = Operand::stack_pointer();
      p.displacement = local_offset(variable.id);
      return p;
    case Storage::IncomingRayPayloadKHR:
    case Storage::IncomingCallableDataKHR:
    case Storage::ShaderRecordBufferKHR:
    case Storage::HitAttributeKHR:
      return interface_pointer(variable, p);
    case Storage::StorageBuffer:
    case Storage::Uniform:
      return buffer_pointer(variable, p);
    case Storage::Workgroup:
      p.space = PointerSpace::Shared;
      p.displacement = shared_offset(variable.id);
      return p;
    case Storage::PushConstant:
      p.space = PointerSpace::Constant;
      p.displacement = isa::kPushConstantOffset;
      p.is_constant = true;
      return p;
    case Storage::UniformConstant:
      p.space = PointerSpace::Resource;
      return p;
    case Storage::Input:
      if (d.builtin)
        p.space = PointerSpace::Builtin;
      else
        unsupported(fmt::format("input variable {}", module_.name_of(variable.id)), variable.line);
      return p;
    default:
      unsupported(fmt::format("storage class {} of {}", name_of_storage_class(uint32_t(variable.storage)),
                              module_.name_of(variable.id)),
                  variable.line);
      return p;
  }
}

// Returns the pointer of an id. Pointers of variables are not kept: each block loads the base of a buffer
// again, because a load from the constant bank is cheaper than a register pair that lives across a trace.
Pointer ModuleLowering::pointer(Id id) {
  if (const auto it = pointers_.find(id); it != pointers_.end()) return it->second;
  if (const auto it = module_.variables.find(id); it != module_.variables.end())
    return variable_pointer(it->second);
  if (const auto it = local_variables_.find(id); it != local_variables_.end())
    return variable_pointer(it->second);
  if (const auto type = type_of_id_.find(id); type != type_of_id_.end() && layout_.is_address(type->second))
    return pointer_from_value(id);
  unsupported(fmt::format("{} as a pointer", module_.name_of(id)));
  return {};
}

Pointer ModuleLowering::pointer_from_value(Id id) {
  const Type& type = module_.type(type_of(id));
  Pointer p;
  p.type = type.element;
  if (layout_.is_array_of_blocks(p.type)) {
    p.space = PointerSpace::Resource;
    p.table = scalar(id);
    return p;
  }
  p.space = type.storage == spv::StorageClass::Workgroup ? PointerSpace::Shared : PointerSpace::Global;
  p.base = scalar(id);
  p.alignment = 4;  // the default of every access; wider parts have ops of their own
  return p;
}

namespace {

// Splits an index into rest + addend by following additions of constants. Choice: the sum is taken as if it
// did not wrap, which differs only for indices outside of any buffer of 4 GiB.
struct SplitIndex {
  Operand rest;
  int64_t addend = 0;
};

SplitIndex split_index(ModuleLowering& l, Id id) {
  SplitIndex split;
  while (const Instruction* def = l.definition(id)) {
    if ((def->op != spv::Op::OpIAdd && def->op != spv::Op::OpISub) || l.layout().num_parts(def->type) != 1)
      break;
    const auto right = l.module().constant_u32(def->operands[1]),
               left = l.module().constant_u32(def->operands[0]);
    if (right)
      split.addend += def->op == spv::Op::OpIAdd ? int64_t(int32_t(*right)) : -int64_t(int32_t(*right));
    else if (left && def->op == spv::Op::OpIAdd)
      split.addend += int32_t(*left);
    else
      break;
    id = def->operands[right ? 0 : 1];
  }
  split.rest = l.word(id);
  if (split.rest.kind == Operand::Kind::Constant) {
    split.addend += int32_t(split.rest.constant);
    split.rest = Operand::value(0);
  }
  return split;
}

void step_elements(ModuleLowering& l, Pointer* p, Id index, uint32_t stride) {
  const SplitIndex split = split_index(l, index);
  p->displacement += split.addend * stride;
  if (is_constant(split.rest, 0)) return;
  p->alignment = std::min(p->alignment, 1u << std::countr_zero(stride | 16u));
  p->base = l.emit().value(p->space == PointerSpace::Global ? "mad.wide.s32" : "mad.lo.u32",
                           {split.rest, Operand::value(stride), p->base});
}

void step_memory(ModuleLowering& l, Pointer* p, Id index) {
  const Type& type = l.module().type(p->type);
  if (type.kind == Type::Kind::Struct) {
    const uint32_t member = l.module().constant_u32(index).value_or(0);
    p->displacement += l.layout().member_offset(p->type, member);
    p->matrix = l.layout().member_matrix(p->type, member, p->matrix);
    p->is_volatile |= type.members[member].is_volatile;
    p->type = type.members[member].type;
    return;
  }
  if (type.kind == Type::Kind::Matrix && p->matrix.row_major) {
    step_elements(l, p, index, l.layout().size(l.module().type(type.element).element));
    p->component_stride = l.layout().element_stride(p->type, p->matrix);
  } else {
    const bool scattered = type.kind == Type::Kind::Vector && p->component_stride != 0;
    step_elements(l, p, index,
                  scattered ? p->component_stride : l.layout().element_stride(p->type, p->matrix));
  }
  p->type = type.element;
}

// Steps into a built-in or an attribute pair, where the displacement counts parts.
void step_parts(ModuleLowering& l, Pointer* p, Id index) {
  const auto constant = l.module().constant_u32(index);
  const Id element = l.layout().member_type(p->type, constant.value_or(0));
  if (constant) {
    p->displacement += l.layout().first_part(p->type, *constant);
  } else {
    const Operand parts = Operand::value(l.layout().num_parts(element));
    p->part_index = l.emit().value("mad.lo.u32", {l.word(index), parts, p->part_index});
  }
  p->type = element;
}

uint32_t flat_count(const Module& module, Id type) {
  uint32_t count = 1;
  for (const Type* t = &module.type(type); t->kind == Type::Kind::Array; t = &module.type(t->element))
    count *= t->count;
  return count;
}

// Steps to an element of an array of descriptors or of ray queries. The elements are numbered through all
// dimensions.
void step_number(ModuleLowering& l, Pointer* p, Id index) {
  const Id element = l.module().type(p->type).element;
  const Operand stride = Operand::value(flat_count(l.module(), element));
  p->base = l.emit().value("add.u32", {p->base, l.emit().value("mul.lo.u32", {l.word(index), stride})});
  p->type = element;
  const Type& type = l.module().type(element);
  if (p->space == PointerSpace::Resource && type.kind == Type::Kind::Struct) *p = l.buffer_element(*p);
}

// Follows the indices from operand `first` on.
void walk_chain(ModuleLowering& l, const Instruction& inst, Pointer p, size_t first) {
  for (size_t i = first; i < inst.operands.size() && p.space != PointerSpace::Nowhere; ++i) {
    const Id index = inst.operands[i];
    switch (p.space) {
      case PointerSpace::RayQuery:
      case PointerSpace::Resource:
        step_number(l, &p, index);
        break;
      case PointerSpace::Builtin:
      case PointerSpace::AttributePair:
        step_parts(l, &p, index);
        break;
      case PointerSpace::Local:
      case PointerSpace::Global:
      case PointerSpace::Shared:
      case PointerSpace::Constant:
      case PointerSpace::Texel:
      case PointerSpace::Nowhere:
        step_memory(l, &p, index);
        break;
    }
  }
  p.type = l.module().type(inst.type).element;
  l.set_pointer(inst.result, p);
}

void access_chain(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  walk_chain(l, inst, l.pointer(inst.operands[0]), 1);
}

// Returns whether the stated strides apply. In shared memory they apply only where its variables are blocks
// (SPIR-V, "Memory Object Layout").
bool has_stated_strides(const ModuleLowering& l, PointerSpace space) {
  if (space != PointerSpace::Shared) return true;
  for (const auto& [id, variable] : l.module().variables)
    if (variable.storage == spv::StorageClass::Workgroup &&
        l.module().type(l.module().type(variable.type).element).is_block)
      return true;
  return false;
}

// Lowers OpPtrAccessChain, whose first index steps over the pointer's own element.
void pointer_access_chain(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Pointer p = l.pointer(inst.operands[0]);
  const Type& type = l.module().type(l.type_of(inst.operands[0]));
  if (p.space != PointerSpace::Global && p.space != PointerSpace::Shared)
    return l.unsupported("OpPtrAccessChain of this pointer");
  const bool is_stated = type.array_stride != 0 && has_stated_strides(l, p.space);
  step_elements(l, &p, inst.operands[1], is_stated ? type.array_stride : l.layout().size(type.element));
  walk_chain(l, inst, p, 2);
}

// Returns the pointer with what the memory operands from `operand` on say: whether the value of an earlier
// access must not be reused, and the alignment.
Pointer accessed(ModuleLowering& l, const Instruction& inst, Id pointer, size_t operand) {
  Pointer p = l.pointer(pointer);
  if (inst.operands.size() <= operand) return p;
  using Mask = spv::MemoryAccessMask;
  const uint32_t mask = inst.operands[operand];
  p.is_volatile |= (mask & (uint32_t(Mask::Volatile) | uint32_t(Mask::MakePointerVisible))) != 0;
  if ((mask & uint32_t(Mask::Aligned)) != 0 && inst.operands.size() > operand + 1 && p.component_stride == 0)
    p.known_alignment = inst.operands[operand + 1];
  return p;
}

void load(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.set(inst.result, l.load(accessed(l, inst, inst.operands[0], 1)));
}

void store(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.store(accessed(l, inst, inst.operands[0], 2), Operands(l.value(inst.operands[1])));
}

void copy_memory(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.store(l.pointer(inst.operands[0]), l.load(l.pointer(inst.operands[1])));
}

// Computes (bytes of the buffer - offset of the array) / stride, or 0 where the buffer ends before the array.
// The second register pair of the descriptor holds the bytes.
void array_length(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Pointer p = l.pointer(inst.operands[0]);
  const Decorations& d = l.decorations(p.variable);
  const bool in_table = p.entry.kind != Operand::Kind::None;
  if (p.space != PointerSpace::Global || (!in_table && !d.binding))
    return l.unsupported("OpArrayLength of this pointer");
  const uint32_t descriptor = isa::descriptor_offset(d.set.value_or(0), d.binding.value_or(0));
  const Operand bytes =
      in_table ? l.emit().load("ld.global.b32", p.entry, 8, 1, 1)[0]
               : l.emit().load("ld.const.b32", Operand::value(0), int32_t(descriptor + 8), 1, 1)[0];
  const uint32_t offset = l.layout().member_offset(p.type, inst.operands[1]);
  const uint32_t stride =
      l.layout().element_stride(l.module().type(p.type).members.at(inst.operands[1]).type, {});
  Operand before = Operand::value(offset), behind = bytes;
  if (offset) behind = l.emit().value("sub.u32", {l.emit().value("max.u32", {bytes, before}), before});
  l.set(inst.result, {l.emit().value("div.u32", {behind, Operand::value(stride)})});
}

using enum spv::Op;
constexpr LoweringRow kPointerRows[] = {
    {OpAccessChain, access_chain, ""},
    {OpInBoundsAccessChain, access_chain, ""},
    {OpPtrAccessChain, pointer_access_chain, ""},
    {OpInBoundsPtrAccessChain, pointer_access_chain, ""},
    {OpLoad, load, ""},
    {OpStore, store, ""},
    {OpCopyMemory, copy_memory, ""},
    {OpArrayLength, array_length, ""},
};

}  // namespace

std::span<const LoweringRow> memory_rows() {
  return kPointerRows;
}

}  // namespace glint::frontend
