// Turns arguments that are copied in and out into the caller's own variables.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace glint::frontend {

// GLSL's `inout` copies a variable to a parameter and back around each call. After inlining, an array of N
// elements costs 4 N accesses per call. Where nothing can tell the difference, the call takes the address of
// the variable itself.
std::vector<uint32_t> with_references(const std::vector<uint32_t>& spirv);

}  // namespace glint::frontend
