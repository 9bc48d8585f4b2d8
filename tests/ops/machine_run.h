// Runs a launch on either machine, and counts the lanes that executed an op.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/launch.h"
#include "isa/op_row.h"

namespace glint::test {

// Runs the launch on the timing machine, which then has two cores, or on the functional machine, where a warp
// may execute `instruction_budget` instructions. Adds the lanes that executed `counted` to `lanes`, also when
// a fault ends the launch with an Error.
void run_machine(const exec::World& world, bool timing, uint64_t instruction_budget,
                 const isa::OpRow& counted, uint64_t& lanes);

}  // namespace glint::test
