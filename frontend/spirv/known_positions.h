// Positions of hit triangles (SPV_KHR_ray_tracing_position_fetch) said in SPIR-V that older SPIRV-Tools know.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <spirv/unified1/spirv.hpp11>
#include <vector>

namespace glint::frontend {

// Numbers of SPV_KHR_ray_tracing_position_fetch, which the headers of Debian 12 lack.
inline constexpr auto kHitTriangleVertexPositions = spv::BuiltIn(5335);
inline constexpr auto kRayTracingPositionFetch = spv::Capability(5336);
inline constexpr auto kGetIntersectionTriangleVertexPositions = spv::Op(5340);
inline constexpr auto kRayQueryPositionFetch = spv::Capability(5391);

// The instruction becomes OpRayQueryGetIntersectionObjectToWorldKHR of an intersection this much larger than
// 0 or 1.
inline constexpr uint32_t kPositionsOfIntersection = 2;

// The built-in variable gets its number as a Location, which no other input of these stages has; the
// instruction becomes a matrix whose first columns are the corners. Modules that use neither come back as
// they are.
std::vector<uint32_t> with_known_positions(std::vector<uint32_t> spirv);

}  // namespace glint::frontend
