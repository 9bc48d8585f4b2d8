// Turns local variables into SSA values in functions where the optimiser's own pass takes too long.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "frontend/spirv/words.h"

namespace glint::frontend {

// Choice: the time of ssa-rewrite of SPIRV-Tools grows with the square of the loads and stores of a variable,
// because it looks at all of them again for each. 2,000 take it 0.1 s, and 12,000 take it 30 s.
inline constexpr uint32_t kMostAccesses = 2000;

// Returns a valid module in which the functions that access one of their variables more than `most` times
// keep no variable of numbers that they only load and store as a whole. A phi stands only where values
// meet. A value that nothing has stored is undefined. A module that cannot be parsed is returned unchanged.
Words with_promoted_variables(Words spirv, uint32_t most);

}  // namespace glint::frontend
