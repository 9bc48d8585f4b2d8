// Marks every function of a module, so that its instructions still say after inlining under which calls they
// stand. SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

namespace glint::frontend {

// The module with a DebugFunction a function and a DebugScope a block (NonSemantic.Shader.DebugInfo.100): the
// optimiser's inlining adds a DebugInlinedAt a call to them, with the line of the call. Nothing that is
// computed changes. None where that cannot be: modules below version 1.6, without lines, or with instructions
// of another non-semantic set.
std::optional<std::vector<uint32_t>> with_inline_scopes(const std::vector<uint32_t>& words);

// A module that was marked and then optimised, without what the optimiser writes where it must not stand
// (DebugNoLine).
std::vector<uint32_t> without_stray_lines(const std::vector<uint32_t>& words);

// The module with lines as OpLine where it has DebugLine, and without other debug information of that set; of
// modules without it a copy.
std::vector<uint32_t> with_plain_lines(const std::vector<uint32_t>& words);

}  // namespace glint::frontend
