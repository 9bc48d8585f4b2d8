// Chooses which passes of SPIRV-Tools a module gets: the list R1, after which everything is inlined,
// scalarised and in SSA form, and no result of arithmetic has changed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "frontend/spirv/inlined_size.h"

namespace glint::frontend {

inline constexpr const char* kSsaRewrite = "--ssa-rewrite";

struct PassList {
  std::vector<std::string> names;  // as flags of SPIRV-Tools; the first one strips foreign debug sets
  // If present, Glint promotes variables with more accesses than this (promoted_variables.h) before
  // ssa-rewrite.
  std::optional<uint32_t> promotes_over;
};

// Returns R1 for a module that becomes as large as `size` says. Large modules get fewer passes.
PassList passes_of(const std::vector<uint32_t>& spirv, const InlinedSize& size);

// Returns passes that only fold constants, before lengths of arrays are looked at.
PassList constants_only();

// Returns passes that only inline functions, for modules that R1 makes invalid.
PassList inlining_only();

}  // namespace glint::frontend
