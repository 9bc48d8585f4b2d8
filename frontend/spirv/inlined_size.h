// Computes how large a module becomes when every call is inlined, and refuses modules that become too large.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// Returns how many calls are inlined. Throws UnsupportedError when the inlined functions would have more than
// kMostInlined instructions. The message names the function that contributes most. Choice: the largest public
// shader known has 100,000 instructions; a quarter of a million takes some 20 s to compile.
inline constexpr uint64_t kMostInlined = 250'000;
uint64_t check_inlined_size(const std::vector<uint32_t>& spirv, const std::string& name);

}  // namespace glint::frontend
