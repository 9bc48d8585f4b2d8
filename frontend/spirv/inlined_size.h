// How large a module becomes when every call is put in place, and a refusal of what would become too large.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// UnsupportedError when the inlined functions would have more than kMostInlined instructions; it names the
// one that makes most of them. Choice: the largest public shader known has 100,000; a quarter of a million
// takes some 20 s to compile.
inline constexpr uint64_t kMostInlined = 250'000;
void check_inlined_size(const std::vector<uint32_t>& spirv, const std::string& name);

}  // namespace glint::frontend
