// Carries the prints of SPIR-V modules (NonSemantic.DebugPrintf) through the optimiser.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

namespace glint::frontend {

inline constexpr std::string_view kDebugPrintSet = "NonSemantic.DebugPrintf";

// SPIRV-Tools' passes skip modules that import an unknown set such as NonSemantic.DebugPrintf. They know
// OpenCL's set and keep a printf of it in its place, as an instruction with an effect. with_known_prints()
// turns debug prints into such printfs, and with_debug_prints() turns them back.
std::vector<uint32_t> with_known_prints(const std::vector<uint32_t>& words);
std::vector<uint32_t> with_debug_prints(const std::vector<uint32_t>& words);

}  // namespace glint::frontend
