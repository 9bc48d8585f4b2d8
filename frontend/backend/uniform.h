// Finds the values that a machine with a uniform datapath keeps out of its threads' registers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend {

// Returns, by register, whether its value is the same for all threads of a launch and is computed once, from
// constants and parameters, by integer ops.
std::vector<bool> find_uniform(VirtualProgram& program);

}  // namespace glint::frontend
