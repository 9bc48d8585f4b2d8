// Computes differences between the lanes of a quad, for derivatives and for levels of samples.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/lower/lowering.h"

namespace glint::frontend {

// Returns whether the module groups its threads into quads.
bool has_derivatives(ModuleLowering& lowering);

// Returns the differences of 32-bit floats times `scale`: those of all coordinates in x, then those in y.
Operands gradients(ModuleLowering& lowering, const Operands& coordinates, const Operand& scale);

}  // namespace glint::frontend
