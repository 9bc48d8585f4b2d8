// What the ops of hit objects do, and the numbers of the values that a shader reads of one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::isa {

// OpRow::detail of a row of the family.
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
  Corner
};

// SPV_NV_shader_invocation_reorder's getters: ho.value's last operand.
enum class HitObjectValue : uint32_t {
  Type,  // 0 empty, 1 hit, 2 miss
  Kind,
  Primitive,
  Geometry,
  Instance,
  CustomIndex,
  RecordIndex,
  RecordAddress,  // of its record in the binding table; the address: 2 of these, low half first
  Tmin = RecordAddress + 2,
  Tmax,  // Tmax: the distance of a hit
  Origin,
  Direction = Origin + 3,  // world space, 3 of these each
  ObjectOrigin = Direction + 3,
  ObjectDirection = ObjectOrigin + 3,
  ObjectToWorld = ObjectDirection + 3,  // row-major 3x4: 12 of these
  WorldToObject = ObjectToWorld + 12,
  Time = WorldToObject + 12,
  Count
};

// OpRow::detail of a row with Effect::Trace.
enum class TraceKind : uint16_t { Ray, HitObject };

}  // namespace glint::isa
