// Marks every function of a module, so that its instructions still name their calls after inlining.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

namespace glint::frontend {

// Returns the module with a DebugFunction for each function and a DebugScope for each block
// (NonSemantic.Shader.DebugInfo.100). When the optimiser inlines a call, it adds a DebugInlinedAt with the
// line of the call to them. The computation stays the same. It returns nothing for modules that cannot be
// marked: those below version 1.6, without lines, or with instructions of another non-semantic set.
std::optional<std::vector<uint32_t>> with_inline_scopes(const std::vector<uint32_t>& words);

// Repairs a marked and then optimised module: marks of a function's variables stand behind the variables,
// before which nothing may stand, and the DebugNoLine is gone that the optimiser writes where it is not
// allowed.
std::vector<uint32_t> with_marks_in_place(const std::vector<uint32_t>& words);

// Returns the module with an OpLine for each DebugLine and without other debug information of that set. A
// module without such debug information is returned unchanged.
std::vector<uint32_t> with_plain_lines(const std::vector<uint32_t>& words);

}  // namespace glint::frontend
