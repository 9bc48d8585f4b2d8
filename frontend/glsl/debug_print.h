// Prints of SPIR-V modules (NonSemantic.DebugPrintf) on their way through the optimiser.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

namespace glint::frontend {

inline constexpr std::string_view kDebugPrintSet = "NonSemantic.DebugPrintf";

// SPIRV-Tools' passes leave modules alone that import such a set. A print of OpenCL's set, which they know,
// is kept by them as something with an effect, in its place: the first function makes one of it, the second
// undoes that.
std::vector<uint32_t> with_known_prints(const std::vector<uint32_t>& words);
std::vector<uint32_t> with_debug_prints(const std::vector<uint32_t>& words);

}  // namespace glint::frontend
