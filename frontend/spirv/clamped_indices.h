// Clamps the indices of a module's accesses, as the optimiser's pass graphics-robust-access does.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// Returns the valid module `words` with each index into a buffer, an array or a vector clamped to the last
// element. `name` is used in messages. Throws UnsupportedError with the optimiser's reason when it cannot
// take the module, for instance because of variable pointers.
std::vector<uint32_t> with_clamped_indices(const std::vector<uint32_t>& words, const std::string& name);

}  // namespace glint::frontend
