// Expresses position fetches of hit triangles (SPV_KHR_ray_tracing_position_fetch) in SPIR-V that older
// SPIRV-Tools know.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <spirv/unified1/spirv.hpp11>
#include <vector>

namespace glint::frontend {

// These numbers of SPV_KHR_ray_tracing_position_fetch are missing in the headers of Debian 12.
inline constexpr auto kHitTriangleVertexPositions = spv::BuiltIn(5335);
inline constexpr auto kRayTracingPositionFetch = spv::Capability(5336);
inline constexpr auto kGetIntersectionTriangleVertexPositions = spv::Op(5340);
inline constexpr auto kRayQueryPositionFetch = spv::Capability(5391);

// The fetch becomes OpRayQueryGetIntersectionObjectToWorldKHR with this number added to its intersection
// operand, which is 0 or 1.
inline constexpr uint32_t kPositionsOfIntersection = 2;

// Rewrites a module. The built-in variable becomes an input whose Location is the built-in's number, which no
// other input of these stages has. The instruction becomes one that gives a matrix whose first columns are
// the corners. Modules that use neither are returned unchanged.
std::vector<uint32_t> with_known_positions(std::vector<uint32_t> spirv);

}  // namespace glint::frontend
