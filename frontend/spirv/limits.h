// Refuses modules that go beyond stated limits, before tools that would take minutes or gigabytes see them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// The most selections and loops that may lie in each other, with those of called functions. Choice: SPIR-V
// lets a tool stop at 1,023 (specification, 2.17, "Control-flow nesting depth"), but the installed
// validator's time grows with the cube of the depth, and 255 take it 0.4 s.
inline constexpr uint32_t kDeepestNesting = 255;

// Throws UnsupportedError with file and line for a variable above kMostLocalBytes, or a nesting above
// kDeepestNesting. The module need not be valid.
void check_limits(const std::vector<uint32_t>& words, const std::string& name);

}  // namespace glint::frontend
