// Runs the blocks of a launch on several threads of the host, with the results of running them in order.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "pipeline/functional_machine.h"

namespace glint::pipeline {

// Runs a launch of several blocks whose shaders do not print, as run_functional() does.
//
// Parts of the launch, which are one block or several short ones, run in windows. While a window runs, memory
// does not change: each part writes to copies of lines (exec/block_memory.h). Then the parts of the window
// take their turns. A part that has read what one before it wrote runs again, alone; all others only put
// their bytes into memory. So every part has seen the memory that it would have seen in order, and which
// blocks make a part or a window decides nothing but time. Where many parts of a window had to run again, as
// with atomics on one counter, the next ones run in order on one thread.
FunctionalCounts run_ahead(const exec::World& world, uint64_t instruction_budget, const LaunchWatch& watch,
                           uint32_t threads);

}  // namespace glint::pipeline
