// Differences between the lanes of a quad, for derivatives and for levels of samples.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/lower/lowering.h"

namespace glint::frontend {

// Does the module put its threads into quads?
bool has_derivatives(ModuleLowering& lowering);

// Of 32-bit floats: the differences of all in x, then in y, times `scale`.
Operands gradients(ModuleLowering& lowering, const Operands& coordinates, const Operand& scale);

}  // namespace glint::frontend
