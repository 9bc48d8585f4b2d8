// Pointers: variables, access chains, and the ops that read and write through them.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <fmt/format.h>

#include "frontend/lower.h"
#include "frontend/spirv.h"

namespace glint::frontend {

Pointer Lowering::buffer_pointer(const Variable& variable, Pointer p) {
  const Decorations& d = decorations(variable.id);
  if (module_.type(p.type).kind != Type::Kind::Struct) unsupported("arrays of buffers", variable.line);
  const uint32_t descriptor =
      d.set.value_or(0) * isa::kSetBytes + d.binding.value_or(0) * isa::kDescriptorBytes;
  p.place = Place::Global;
  p.base = emitter_.load("ld.const.b64", Operand::value(0), int32_t(descriptor), 1, 1)[0];
  p.alignment =
      16;  // Choice: buffers are bound at multiples of 16 bytes (Vulkan minStorageBufferOffsetAlignment)
  p.is_constant = variable.storage == spv::StorageClass::Uniform;
  return p;
}

namespace {

// Objects that lie in the machine, not in memory: numbers mean them.
bool is_numbered(const Module& module, Id type) {
  while (module.type(type).kind == Type::Kind::Array) type = module.type(type).element;
  return module.type(type).kind == Type::Kind::RayQuery || module.type(type).op == spv::Op::OpTypeHitObjectNV;
}

}  // namespace

Pointer Lowering::variable_pointer(const Variable& variable) {
  using Storage = spv::StorageClass;
  Pointer p;
  p.type = module_.type(variable.type).element;
  p.variable = variable.id;
  if (is_numbered(module_, p.type)) {
    p.place = Place::RayQuery;
    p.base = Operand::value(ray_query(variable.id));
    return p;
  }
  const Decorations& d = decorations(variable.id);
  p.is_volatile = d.is_volatile || d.is_coherent;
  if (d.set.value_or(0) >= isa::kMaxSets || d.binding.value_or(0) >= isa::kBindingsPerSet)
    unsupported(fmt::format("descriptor set {} binding {}", d.set.value_or(0), d.binding.value_or(0)),
                variable.line);
  switch (variable.storage) {
    case Storage::Function:
    case Storage::Private:
    case Storage::RayPayloadKHR:
    case Storage::CallableDataKHR:
    case Storage::HitObjectAttributeNV:
      p.place = Place::Local;
      p.base = Operand::stack_pointer();
      p.displacement = local_offset(variable.id);
      return p;
    case Storage::IncomingRayPayloadKHR:
    case Storage::IncomingCallableDataKHR:
      p.place = Place::Local;
      p.base = Operand::of(isa::Special::Payload);
      return p;
    case Storage::ShaderRecordBufferKHR:
      p.place = Place::Global;
      p.base = emitter_.value("pack.b64", {Operand::of(isa::Special::Record), Operand::of(isa::Special::RecordHi)});
      p.is_constant = true;  // Vulkan: shaders only read it
      return p;
    case Storage::HitAttributeKHR: {
      const bool is_pair = layout_.parts(p.type) == std::vector<Part>{Part::Float32, Part::Float32};
      p.place = is_pair && stage() != isa::Stage::Intersection ? Place::AttributePair : Place::Local;
      p.base = attributes_in_frame_ ? Operand::stack_pointer() : Operand::of(isa::Special::Attribute);
      if (attributes_in_frame_) p.displacement = local_offset(variable.id);
      return p;
    }
    case Storage::StorageBuffer:
    case Storage::Uniform:
      return buffer_pointer(variable, p);
    case Storage::PushConstant:
      p.place = Place::Constant;
      p.displacement = isa::kPushConstantOffset;
      p.is_constant = true;
      return p;
    case Storage::UniformConstant:
      p.place = Place::Resource;
      return p;
    case Storage::Input:
      if (d.builtin)
        p.place = Place::Builtin;
      else
        unsupported(fmt::format("input variable {}", module_.name_of(variable.id)), variable.line);
      return p;
    default:
      unsupported(
          fmt::format("storage class {} of {}", name_of_storage_class(uint32_t(variable.storage)), module_.name_of(variable.id)),
          variable.line);
      return p;
  }
}

// Not kept for variables: the base of a buffer is loaded again in each block that uses it, for a load from
// the constant bank is cheaper than a register pair that lives across a trace.
Pointer Lowering::pointer(Id id) {
  if (const auto it = pointers_.find(id); it != pointers_.end()) return it->second;
  if (const auto it = module_.variables.find(id); it != module_.variables.end())
    return variable_pointer(it->second);
  if (const auto it = local_variables_.find(id); it != local_variables_.end())
    return variable_pointer(it->second);
  unsupported(fmt::format("{} as a pointer", module_.name_of(id)));
  return {};
}

namespace {

// index = rest + addend, following additions of constants. Choice: the sum is taken as if it did not wrap,
// which differs only for indices outside of any buffer of 4 GiB.
struct SplitIndex {
  Operand rest;
  int64_t addend = 0;
};

SplitIndex split_index(Lowering& l, Id id) {
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
  split.rest = l.scalar(id);
  if (l.emit().class_of(split.rest) == RegisterClass::B64)
    split.rest = l.emit().value("cvt.u32.u64", {split.rest});
  if (split.rest.kind == Operand::Kind::Constant) {
    split.addend += int32_t(split.rest.constant);
    split.rest = Operand::value(0);
  }
  return split;
}

void step_elements(Lowering& l, Pointer* p, Id index, uint32_t stride) {
  const SplitIndex split = split_index(l, index);
  p->displacement += split.addend * stride;
  if (is_constant(split.rest, 0)) return;
  p->alignment = std::min(p->alignment, 1u << std::countr_zero(stride | 16u));
  p->base = l.emit().value(p->place == Place::Global ? "mad.wide.s32" : "mad.lo.u32",
                           {split.rest, Operand::value(stride), p->base});
}

void step_memory(Lowering& l, Pointer* p, Id index) {
  const Type& type = l.module().type(p->type);
  if (type.kind == Type::Kind::Struct) {
    const uint32_t member = l.module().constant_u32(index).value_or(0);
    p->displacement += l.layout().member_offset(p->type, member);
    p->matrix = l.layout().member_matrix(p->type, member, p->matrix);
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

// Built-ins and attribute pairs: displacement counts parts.
void step_parts(Lowering& l, Pointer* p, Id index) {
  const auto constant = l.module().constant_u32(index);
  if (constant)
    p->displacement += l.layout().first_part(p->type, *constant);
  else if (l.module().type(p->type).kind == Type::Kind::Vector && p->displacement == 0)
    p->part_index = l.scalar(index);
  else
    l.unsupported("dynamic index into a built-in matrix");
  p->type = l.layout().member_type(p->type, constant.value_or(0));
}

void access_chain(Lowering& l, const Instruction& inst, const LoweringRow&) {
  Pointer p = l.pointer(inst.operands[0]);
  for (size_t i = 1; i < inst.operands.size() && p.place != Place::Nowhere; ++i) {
    const Id index = inst.operands[i];
    switch (p.place) {
      case Place::RayQuery:
      case Place::Resource:
        p.base = l.emit().value("add.u32", {p.base, l.scalar(index)});
        p.type = l.module().type(p.type).element;
        break;
      case Place::Builtin:
      case Place::AttributePair:
        step_parts(l, &p, index);
        break;
      case Place::Local:
      case Place::Global:
      case Place::Constant:
      case Place::Nowhere:
        step_memory(l, &p, index);
        break;
    }
  }
  p.type = l.module().type(inst.type).element;
  l.set_pointer(inst.result, p);
}

bool is_volatile(const Instruction& inst, size_t operand) {
  return inst.operands.size() > operand &&
         (inst.operands[operand] & uint32_t(spv::MemoryAccessMask::Volatile)) != 0;
}

void load(Lowering& l, const Instruction& inst, const LoweringRow&) {
  Pointer p = l.pointer(inst.operands[0]);
  p.is_volatile |= is_volatile(inst, 1);
  l.set(inst.result, l.load(p));
}

void store(Lowering& l, const Instruction& inst, const LoweringRow&) {
  l.store(l.pointer(inst.operands[0]), Operands(l.value(inst.operands[1])));
}

void copy_memory(Lowering& l, const Instruction& inst, const LoweringRow&) {
  l.store(l.pointer(inst.operands[0]), l.load(l.pointer(inst.operands[1])));
}

// (bytes of the buffer - offset of the array) / stride; the descriptor's second word pair holds the bytes.
void array_length(Lowering& l, const Instruction& inst, const LoweringRow&) {
  const Pointer p = l.pointer(inst.operands[0]);
  const Decorations& d = l.decorations(p.variable);
  if (p.place != Place::Global || !d.binding) return l.unsupported("OpArrayLength of this pointer");
  const uint32_t descriptor = d.set.value_or(0) * isa::kSetBytes + *d.binding * isa::kDescriptorBytes;
  const Operand bytes = l.emit().load("ld.const.b32", Operand::value(0), int32_t(descriptor + 8), 1, 1)[0];
  const uint32_t offset = l.layout().member_offset(p.type, inst.operands[1]);
  const uint32_t stride =
      l.layout().element_stride(l.module().type(p.type).members.at(inst.operands[1]).type, {});
  l.set(inst.result, {l.emit().value("div.u32", {l.emit().value("sub.u32", {bytes, Operand::value(offset)}),
                                                 Operand::value(stride)})});
}

// Model: stores are seen by later loads in program order, so a barrier only keeps values from being reused.
void memory_barrier(Lowering& l, const Instruction&, const LoweringRow&) {
  l.note_store(Place::Global);
}

using enum spv::Op;
constexpr LoweringRow kRows[] = {
    {OpAccessChain, access_chain, ""},
    {OpInBoundsAccessChain, access_chain, ""},
    {OpLoad, load, ""},
    {OpStore, store, ""},
    {OpCopyMemory, copy_memory, ""},
    {OpArrayLength, array_length, ""},
    {OpMemoryBarrier, memory_barrier, ""},
};

}  // namespace

std::span<const LoweringRow> memory_rows() {
  return kRows;
}

}  // namespace glint::frontend
