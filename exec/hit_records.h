// Finds the record of the shader binding table for a hit (Vulkan, "Hit Shader Binding Table Indexing").
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "exec/image.h"
#include "rtunit/traversal/ray.h"

namespace glint::exec {

inline uint32_t hit_record(const World& world, const rt::Ray& ray, const rt::Hit& hit) {
  return world.table.hit.number(hit.sbt_record + hit.geometry * ray.sbt_stride + ray.sbt_offset);
}

// Returns whether a miss or callable record is in the table and has a handle of the pipeline.
inline bool is_record(const std::vector<uint32_t>& shaders, uint32_t record) {
  return record < shaders.size() && shaders[record] != kForeignShader;
}

// Returns the shaders of the hit, and the number of their record, or null when the record is outside of the
// table or foreign.
inline const HitGroup* hit_group(const World& world, const rt::Ray& ray, const rt::Hit& hit,
                                 uint32_t& record) {
  record = hit_record(world, ray, hit);
  return record < world.hit.size() && world.hit[record].closest_hit != kForeignShader ? &world.hit[record]
                                                                                      : nullptr;
}

}  // namespace glint::exec
