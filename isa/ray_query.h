// What the ops of ray queries ask for: the detail of a row of the family.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::isa {

// SPV_KHR_ray_query's instructions. From Type on, values that a shader reads; those up to the last matrix
// element exist for the candidate and, with kCommitted added, for the committed hit.
enum class Query : uint8_t {
  Initialize,
  Confirm,
  Generate,
  Terminate,
  Type,  // candidate: 0 triangle, 1 box; committed: 0 none, 1 triangle, 2 generated
  T,
  Instance,
  CustomIndex,
  SbtOffset,
  Geometry,
  Primitive,
  BarycentricU,
  BarycentricV,
  FrontFace,     // 0 or 1
  AabbOpaque,    // 0 or 1; of a candidate only
  ObjectOrigin,  // 3 of these
  ObjectDirection = ObjectOrigin + 3,
  ObjectToWorld = ObjectDirection + 3,  // row-major 3x4: 12 of these
  WorldToObject = ObjectToWorld + 12,
  Corner = WorldToObject + 12,  // of the triangle: x, y, z of the first, of the second, of the third
  Tmin = Corner + 9,            // of the ray
  Flags,
  Origin,
  Direction = Origin + 3,
  Count = Direction + 3
};
inline constexpr uint16_t kCommitted = 0x100;

// OpRow::detail of a row of the family.
constexpr uint16_t detail_of(Query query, bool committed = false, int element = 0) {
  return uint16_t(uint16_t(query) + element + (committed ? kCommitted : 0));
}

}  // namespace glint::isa
