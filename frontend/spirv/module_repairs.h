// Changes SPIR-V so that the optimiser accepts it. A module keeps its behaviour; where it does not, the user
// is told.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// Returns true when the length of an array depends on specialisation constants.
bool has_specialised_lengths(const std::vector<uint32_t>& spirv);

// Gives one element to arrays whose length is a constant 0. Specialisation constants that nobody set make
// such lengths, and the validator refuses them. `names` gets the names of the constants or arrays, as far as
// the module has names.
std::vector<uint32_t> with_positive_lengths(std::vector<uint32_t> spirv, std::vector<std::string>* names);

// Replaces the instructions that end any-hit shaders inside functions by the vendor's instructions, which are
// not terminators, followed by a return. The optimiser does not inline functions that end a shader into the
// continue construct of a loop.
std::vector<uint32_t> with_ends_that_return(const std::vector<uint32_t>& spirv);

// Writes the size that the constant decorated WorkgroupSize has into the execution mode LocalSize, which it
// overrides (SPIR-V specification, 3.6). The optimiser removes that constant where no code reads it.
std::vector<uint32_t> with_local_size(std::vector<uint32_t> spirv);

// Returns true when the module still has calls.
bool has_calls(const std::vector<uint32_t>& spirv);

}  // namespace glint::frontend
