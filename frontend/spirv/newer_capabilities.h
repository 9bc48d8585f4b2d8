// Names the capabilities of SPIR-V that are younger than the oldest SPIRV-Tools that Glint is built with.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

namespace glint::frontend {

// Returns the name of a capability, or "" when the table does not have it. Source: the registry of SPIR-V,
// unified1/spirv.core.grammar.json of August 2026, without what the headers of January 2023 have.
std::string_view newer_capability(uint32_t capability);

}  // namespace glint::frontend
