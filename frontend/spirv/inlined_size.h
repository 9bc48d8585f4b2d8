// Computes how large a module becomes when every call is inlined, and refuses modules that become too large.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// Choice: the largest public shader known has 100,000 instructions; a quarter of a million takes some 20 s to
// compile.
inline constexpr uint64_t kMostInlined = 250'000;

// Holds counts over all copies of all functions.
struct InlinedSize {
  uint64_t instructions = 0;
  uint64_t calls = 0;  // that are inlined
};

// Returns how large the module becomes. Throws UnsupportedError when the inlined functions would have more
// than kMostInlined instructions. The message names the function that contributes most.
InlinedSize check_inlined_size(const std::vector<uint32_t>& spirv, const std::string& name);

}  // namespace glint::frontend
