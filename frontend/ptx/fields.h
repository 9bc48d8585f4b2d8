// Inserts fields at constant places without the op for any place.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {

// Makes a shift and logic of three words of each `bfi.b32` with a constant position and length, as the
// hardware's assembler does.
void expand_fields(Draft& draft, VirtualProgram& program);

}  // namespace glint::frontend::ptx
