// Names what the ops of hit objects do, and numbers the values that a shader reads from one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "isa/stage.h"

namespace glint::isa {

// Names the op of a row of the family, in OpRow::detail.
enum class HitObjectOp : uint16_t {
  Record,
  Empty,
  Miss,
  Hit,
  HitAtRecord,
  Value,
  Attributes,
  SetTime,
  GetTime,
  Corner,
  // These are of Effect::Reorder.
  Reorder,
  ReorderByHint,
  ReorderByTrace
};

// Returns the stages whose shaders may contain the op.
constexpr StageSet stages_of(HitObjectOp op) {
  if (op == HitObjectOp::GetTime) return {Stage::Intersection, Stage::AnyHit, Stage::ClosestHit, Stage::Miss};
  if (op == HitObjectOp::Corner) return {Stage::AnyHit, Stage::ClosestHit};
  if (op == HitObjectOp::Reorder || op == HitObjectOp::ReorderByHint) return {Stage::RayGeneration};
  return {Stage::RayGeneration, Stage::ClosestHit, Stage::Miss};
}

// Numbers the getters of SPV_NV_shader_invocation_reorder. The number is the last operand of ho.value.
enum class HitObjectValue : uint32_t {
  Type,  // 0 empty, 1 hit, 2 miss
  Kind,
  Primitive,
  Geometry,
  Instance,
  CustomIndex,
  // The hit's record in the binding table. The address has two words, low half first.
  RecordIndex,
  RecordAddress,
  Tmin = RecordAddress + 2,
  Tmax,  // for a hit, its distance
  // The origin and the direction have 3 components each, in world space and then in object space.
  Origin,
  Direction = Origin + 3,
  ObjectOrigin = Direction + 3,
  ObjectDirection = ObjectOrigin + 3,
  ObjectToWorld = ObjectDirection + 3,  // row-major 3x4: 12 components
  WorldToObject = ObjectToWorld + 12,
  Time = WorldToObject + 12,
  Count
};

// Names the kind of a trace, in OpRow::detail of a row with Effect::Trace.
enum class TraceKind : uint16_t { Ray, HitObject };

}  // namespace glint::isa
