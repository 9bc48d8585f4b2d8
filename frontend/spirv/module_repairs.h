// Changes to SPIR-V that let the optimiser through: they keep what a module does, and what it does not keep
// is said. SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// True where the length of an array hangs on specialisation constants.
bool has_specialised_lengths(const std::vector<uint32_t>& spirv);

// Arrays whose length is a constant 0 get one element: specialisation constants that nobody set make such
// lengths, and the validator refuses them. `names` gets the names of the constants or arrays as far as the
// module tells them.
std::vector<uint32_t> with_positive_lengths(std::vector<uint32_t> spirv, std::vector<std::string>* names);

// Ends of any-hit shaders inside functions become the vendor's instructions, which are no terminators, with a
// return behind them: functions that end a shader are not inlined into the continue construct of a loop.
std::vector<uint32_t> with_ends_that_return(const std::vector<uint32_t>& spirv);

// Calls are left in the module.
bool has_calls(const std::vector<uint32_t>& spirv);

}  // namespace glint::frontend
