// Names what the ops of ray queries ask for, in the detail of a row of the family.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::isa {

// Lists the instructions of SPV_KHR_ray_query. From Type on, they are values that a shader reads. The values
// up to the last matrix element exist for the candidate and, with kCommitted added, for the committed hit.
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
  ObjectOrigin,  // 3 components
  ObjectDirection = ObjectOrigin + 3,
  ObjectToWorld = ObjectDirection + 3,  // row-major 3x4: 12 components
  WorldToObject = ObjectToWorld + 12,
  Corner = WorldToObject + 12,  // corners of the triangle: x, y, z of each of the three
  // The values from here on belong to the ray.
  Tmin = Corner + 9,
  Flags,
  Origin,
  Direction = Origin + 3,
  Count = Direction + 3
};
inline constexpr uint16_t kCommitted = 0x100;

// Returns the OpRow::detail of a row of the family.
constexpr uint16_t detail_of(Query query, bool committed = false, int element = 0) {
  return uint16_t(uint16_t(query) + element + (committed ? kCommitted : 0));
}

}  // namespace glint::isa
