// Refuses modules that go beyond stated limits, before tools that would take minutes or gigabytes see them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// The most selections and loops that may lie in each other, with those of called functions. A chain of `else
// if` counts one for each link. Source: SPIR-V specification, 2.17 ("Control-flow nesting depth").
inline constexpr uint32_t kDeepestNesting = 1023;

// The most loops among them. Choice: the times of the installed tools grow with the cube of the depth; 127
// take them 1 s, and 250 take them 7 s.
inline constexpr uint32_t kDeepestLoops = 127;

// The most calls that may lie in each other. Choice: the time of the optimiser's inliner grows with the
// square of the depth; 1,000 take it 0.2 s, and 3,000 take it 2 s.
inline constexpr uint32_t kDeepestCalls = 1000;

// The deepest nesting that the validator looks at. Choice: its time grows with the cube of the depth; 255
// take it 0.4 s, and 1,000 take it 25 s. validate_spirv() lets deeper modules pass, which only glslang may
// make.
inline constexpr uint32_t kDeepestValidated = 255;

// The most selections and loops of a module of glslang or the optimiser that the validator looks at. Choice:
// its time grows with more than their number; 8,000 take it 1.2 s. The largest public shader known has 1,800.
inline constexpr uint32_t kMostValidated = 2500;

// Returns how many selections and loops the functions have. The module need not be valid.
uint32_t selections_and_loops_of(const std::vector<uint32_t>& words);

// Returns how deep selections and loops lie in each other. The module need not be valid.
uint32_t nesting_of(const std::vector<uint32_t>& words);

// Returns the bytes of the largest variable of one thread. The module need not be valid.
uint64_t largest_variable(const std::vector<uint32_t>& words);

// Throws UnsupportedError with file and line for a variable above kMostLocalBytes, a nesting above `deepest`,
// loops above kDeepestLoops, or calls above kDeepestCalls. The module need not be valid.
void check_limits(const std::vector<uint32_t>& words, const std::string& name,
                  uint32_t deepest = kDeepestNesting);

}  // namespace glint::frontend
