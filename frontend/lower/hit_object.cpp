// Lowers hit objects (SPV_NV_shader_invocation_reorder): traces whose hit is kept, hits made by the shader,
// the values of hits and the calls of their shaders.
// SPDX-License-Identifier: Apache-2.0
#include "isa/hit_object.h"

#include <string_view>
#include <utility>

#include "frontend/lower/lowering.h"

namespace glint::frontend {
namespace {

using isa::HitObjectValue;

// Returns the number of an object among those of the shader.
Operand object(ModuleLowering& l, Id id) {
  const Pointer p = l.pointer(id);
  if (p.space != PointerSpace::RayQuery) l.unsupported("a hit object that is not a variable");
  return p.base;
}

void append(ModuleLowering& l, Operands& to, std::span<const uint32_t> values) {
  for (const Id id : values) {
    const Operands& parts = l.value(id);
    to.insert(to.end(), parts.begin(), parts.end());
  }
}

// Sets the time of a ray, which is the operand before the last in the forms with motion.
void set_time(ModuleLowering& l, const Instruction& inst, size_t operand) {
  l.emit().effect("rt.time.set", {l.scalar(inst.operands[operand])});
}

// The operands are: object, the ten arguments of a trace, time (in the form with motion), payload.
void trace_kept(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operand which = object(l, inst.operands[0]);
  if (inst.op == spv::Op::OpHitObjectTraceRayMotionNV) set_time(l, inst, 11);
  lower_trace(l, std::span(inst.operands).subspan(1, 10), l.pointer(inst.operands.back()),
              [&] { l.emit().effect("ho.record", {which}); });
}

// The operands are: object, structure, instance, primitive, geometry, kind, record (or offset and stride),
// origin, t min, direction, t max, time (in the forms with motion), attributes.
void record_hit(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const size_t count = row.name32 == "ho.hit" ? 11 : 10;
  Operands operands{object(l, inst.operands[0])};
  append(l, operands, std::span(inst.operands).subspan(1, count));
  operands.push_back(local_address(l, l.pointer(inst.operands.back())));
  if (inst.operands.size() == count + 3) set_time(l, inst, count + 1);
  l.emit().effect(row.name32, std::move(operands));
}

void record_miss(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Operands operands{object(l, inst.operands[0])};
  append(l, operands, std::span(inst.operands).subspan(1, 5));
  if (inst.op == spv::Op::OpHitObjectRecordMissMotionNV) set_time(l, inst, 6);
  l.emit().effect("ho.miss", std::move(operands));
}

void record_empty(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.emit().effect("ho.empty", {object(l, inst.operands[0])});
}

void execute(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const Operand which = object(l, inst.operands[0]), payload = local_address(l, l.pointer(inst.operands[1]));
  const Operand attributes = attribute_buffers_address(l);
  e.marker(VirtualInst::Kind::SaveLive);
  e.effect("ho.execute", {which, payload, attributes});
  e.effect("call.sbt.hit", {});
  e.effect("rt.end", {});
  e.marker(VirtualInst::Kind::RestoreLive);
  forget_after_call(l);
}

Operand value(ModuleLowering& l, const Instruction& inst, HitObjectValue field, uint32_t element = 0) {
  return l.emit().fresh("ho.value", {object(l, inst.operands[0]), Operand::value(uint32_t(field) + element)});
}

template <HitObjectValue kField>
void get(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Operands parts;
  for (uint32_t i = 0; i < l.layout().num_parts(inst.type); ++i) parts.push_back(value(l, inst, kField, i));
  l.set(inst.result, std::move(parts));
}

// Returns four columns of three rows. The ISA's values are row by row.
template <HitObjectValue kField>
void get_matrix(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Operands parts;
  for (uint32_t column = 0; column < 4; ++column)
    for (uint32_t row = 0; row < 3; ++row) parts.push_back(value(l, inst, kField, 4 * row + column));
  l.set(inst.result, std::move(parts));
}

template <uint32_t kType>
void is_of_type(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.set(inst.result,
        {l.emit().value("setp.eq.u32", {value(l, inst, HitObjectValue::Type), Operand::value(kType)})});
}

void get_attributes(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operand address = local_address(l, l.pointer(inst.operands[1]));
  l.emit().effect("ho.attributes", {object(l, inst.operands[0]), address});
  l.note_store(PointerSpace::Local);
}

// Emits the op with its operands, the last of which, the number of live registers, the backend fills in. What
// was computed is forgotten, because the lane of a thread may be another one afterwards. Without a core that
// regroups lanes, all of them stay in their warps, and the call is nothing.
void reorder(ModuleLowering& l, std::string_view op, Operands operands) {
  operands.push_back(Operand::value(0));
  l.emit().effect(op, std::move(operands));
  l.emit().forget();
}

// The operands are: object, and hint and number of bits if there is a hint.
void reorder_by_object(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  if (!l.reorders()) return;
  Operands operands{object(l, inst.operands[0])};
  for (size_t i = 1; i < 3; ++i)
    operands.push_back(i < inst.operands.size() ? l.scalar(inst.operands[i]) : Operand::value(0));
  reorder(l, row.name32, std::move(operands));
}

void reorder_by_hint(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  if (l.reorders()) reorder(l, row.name32, {l.scalar(inst.operands[0]), l.scalar(inst.operands[1])});
}

using enum spv::Op;
constexpr LoweringRow kHitObjectRows[] = {
    {OpHitObjectTraceRayNV, trace_kept, ""},
    {OpHitObjectTraceRayMotionNV, trace_kept, ""},
    {OpHitObjectRecordHitNV, record_hit, "ho.hit"},
    {OpHitObjectRecordHitMotionNV, record_hit, "ho.hit"},
    {OpHitObjectRecordHitWithIndexNV, record_hit, "ho.hit.record"},
    {OpHitObjectRecordHitWithIndexMotionNV, record_hit, "ho.hit.record"},
    {OpHitObjectRecordMissNV, record_miss, ""},
    {OpHitObjectRecordMissMotionNV, record_miss, ""},
    {OpHitObjectRecordEmptyNV, record_empty, ""},
    {OpHitObjectExecuteShaderNV, execute, ""},
    {OpHitObjectGetAttributesNV, get_attributes, ""},
    {OpHitObjectIsEmptyNV, is_of_type<0>, ""},
    {OpHitObjectIsHitNV, is_of_type<1>, ""},
    {OpHitObjectIsMissNV, is_of_type<2>, ""},
    {OpHitObjectGetHitKindNV, get<HitObjectValue::Kind>, ""},
    {OpHitObjectGetPrimitiveIndexNV, get<HitObjectValue::Primitive>, ""},
    {OpHitObjectGetGeometryIndexNV, get<HitObjectValue::Geometry>, ""},
    {OpHitObjectGetInstanceIdNV, get<HitObjectValue::Instance>, ""},
    {OpHitObjectGetInstanceCustomIndexNV, get<HitObjectValue::CustomIndex>, ""},
    {OpHitObjectGetShaderBindingTableRecordIndexNV, get<HitObjectValue::RecordIndex>, ""},
    {OpHitObjectGetShaderRecordBufferHandleNV, get<HitObjectValue::RecordAddress>, ""},
    {OpHitObjectGetRayTMinNV, get<HitObjectValue::Tmin>, ""},
    {OpHitObjectGetRayTMaxNV, get<HitObjectValue::Tmax>, ""},
    {OpHitObjectGetCurrentTimeNV, get<HitObjectValue::Time>, ""},
    {OpHitObjectGetWorldRayOriginNV, get<HitObjectValue::Origin>, ""},
    {OpHitObjectGetWorldRayDirectionNV, get<HitObjectValue::Direction>, ""},
    {OpHitObjectGetObjectRayOriginNV, get<HitObjectValue::ObjectOrigin>, ""},
    {OpHitObjectGetObjectRayDirectionNV, get<HitObjectValue::ObjectDirection>, ""},
    {OpHitObjectGetObjectToWorldNV, get_matrix<HitObjectValue::ObjectToWorld>, ""},
    {OpHitObjectGetWorldToObjectNV, get_matrix<HitObjectValue::WorldToObject>, ""},
    {OpReorderThreadWithHitObjectNV, reorder_by_object, "ho.reorder"},
    {OpReorderThreadWithHintNV, reorder_by_hint, "ho.reorder.hint"},
};

}  // namespace

std::span<const LoweringRow> hit_object_rows() {
  return kHitObjectRows;
}

}  // namespace glint::frontend
