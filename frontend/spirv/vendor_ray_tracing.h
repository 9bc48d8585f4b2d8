// Rewrites SPV_NV_ray_tracing to SPV_KHR_ray_tracing where the operands of their instructions differ.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace glint::frontend {

// The vendor's extension names payloads and callable data by a constant of their location, so the optimiser
// takes their variables for unused. Traces and calls become the standard instructions, which name the
// variable. Everything else stays.
std::vector<uint32_t> with_standard_traces(const std::vector<uint32_t>& spirv);

}  // namespace glint::frontend
