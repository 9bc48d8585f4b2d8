// Repairs what versions of glslang are known to get wrong, so that valid GLSL is not refused for it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace glint::frontend {

// Returns a module of glslang that the validator refuses, changed in two ways. It declares the capabilities
// of arithmetic with the numbers of 8 and 16 bits that it has: glslang 12 leaves them out where constants are
// made of specialisation constants. A stored structure is copied to the type of its place: glslang 12 stores
// one with another layout where `?:` chooses between structures in memory.
std::vector<uint32_t> with_glslang_repairs(const std::vector<uint32_t>& spirv);

}  // namespace glint::frontend
