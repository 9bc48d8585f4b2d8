// Describes a ray as a shader hands it over, and a hit as the unit hands it back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "base/types.h"

namespace glint::rt {

// These are Vulkan's ray flags (SPV_KHR_ray_tracing, section "Ray Flags").
namespace ray_flag {
inline constexpr uint32_t kOpaque = 0x1, kNoOpaque = 0x2, kTerminateOnFirstHit = 0x4, kSkipClosestHit = 0x8,
                          kCullBackFacing = 0x10, kCullFrontFacing = 0x20, kCullOpaque = 0x40,
                          kCullNoOpaque = 0x80, kSkipTriangles = 0x100, kSkipAabbs = 0x200,
                          kForceMicromaps2State = 0x400;  // SPV_EXT_opacity_micromap
}
inline constexpr uint32_t kHitKindFront = 0xfe, kHitKindBack = 0xff;

struct Ray {
  std::array<float, 3> origin{}, direction{};  // in world space; the direction need not have length 1
  float t_min = 0, t_max = 0;
  uint32_t flags = 0;
  uint32_t cull_mask = 0xff;  // Only the low 8 bits count.
  Address structure = 0;      // virtual address of the top-level structure's header
  uint32_t sbt_offset = 0, sbt_stride = 0, miss_index = 0;
};

inline constexpr uint32_t kNoHit = 0xffff'ffff;

// Describes a candidate or committed hit. There is none if `instance` is kNoHit.
struct Hit {
  float t = 0;
  float u = 0, v = 0;          // weights of vertex 1 and 2 (triangles)
  uint32_t kind = 0;           // kHitKindFront, kHitKindBack or the intersection shader's own
  uint32_t instance = kNoHit;  // index in the top-level structure
  uint32_t geometry = 0, primitive = 0;
  uint32_t custom_index = 0;  // 24 bits
  uint32_t sbt_record = 0;    // the instance's shader-binding-table offset, 24 bits
  Address instance_leaf = 0;  // virtual address of the instance's record, which holds the transforms
  // virtual address of the leaf with the triangle's corners; 0: the hit is on no triangle
  Address triangle_leaf = 0;
  bool valid() const { return instance != kNoHit; }
};

// Says what a lane's traversal waits for.
enum class RayStatus : uint8_t {
  Idle,  // The lane holds no ray.
  Traversing,
  NeedsIntersection,  // An AABB was entered: the intersection shader of `candidate` must run.
  NeedsAnyHit,        // A candidate is not opaque: its any-hit shader must run.
  Gathered,  // The ray has candidates in its table and runs no shader: the any-hit mode presents one.
  Done,      // `committed` is final, or there is no hit.
};

}  // namespace glint::rt
