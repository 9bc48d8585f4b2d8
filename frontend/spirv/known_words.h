// Expresses what young compilers write in SPIR-V that older SPIRV-Tools know.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

namespace glint::frontend {

// Rewrites a module that was read: position fetches (known_positions.h), and source languages that
// SPIRV-Tools of January 2023 do not know, such as Slang, which become Unknown.
std::vector<uint32_t> with_known_words(std::vector<uint32_t> spirv);

}  // namespace glint::frontend
