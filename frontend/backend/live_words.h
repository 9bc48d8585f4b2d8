// Tells instructions at which threads may move how many registers move with a thread.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/backend/allocate.h"
#include "frontend/virtual_program.h"

namespace glint::frontend {

// Sets the last operand of each ho.reorder and ho.reorder.hint to the number of 32-bit registers that are
// live after it. It runs after allocation, which may have given several values one register.
void count_live_words(VirtualProgram& program, const Allocation& allocation);

}  // namespace glint::frontend
