// SPV_NV_ray_tracing in the words of SPV_KHR_ray_tracing, where the two differ in the operands of an
// instruction. SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace glint::frontend {

// The vendor's extension names payloads and callable data by a constant of their location, so that the
// optimiser takes their variables for unused. Traces and calls become the standard ones, which name the
// variable; all else stays.
std::vector<uint32_t> with_standard_traces(const std::vector<uint32_t>& spirv);

}  // namespace glint::frontend
