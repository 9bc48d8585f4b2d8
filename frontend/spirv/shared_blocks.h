// Keeps the optimiser from deleting stores to shared blocks that overlap.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/spirv/words.h"

namespace glint::frontend {

// Returns whether two variables of a module may lie in the same shared memory, which only blocks of
// SPV_KHR_workgroup_memory_explicit_layout do.
bool has_overlapping_shared_blocks(const Words& words);

// Moves the variables of a storage class, and the pointers to them, into another class. The optimiser takes a
// store to a shared variable that nobody loads for dead, and knows nothing of variables that overlap. Shared
// variables therefore spend their time in the optimiser as CrossWorkgroup variables, which shaders do not
// have and whose stores the host could read.
void move_variables(Words& words, spv::StorageClass from, spv::StorageClass to);

}  // namespace glint::frontend
