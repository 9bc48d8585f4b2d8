// Runs a launch on either machine, and counts the lanes that executed an op.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/launch.h"
#include "isa/op_row.h"

namespace glint::test {

// Names the machines: the functional one, a timing machine of two cores, and one of a single core that
// regroups threads where a program says that it may.
enum class Machine { Functional, TwoCores, Sorting };

// Runs the launch. On the functional machine a warp may execute `instruction_budget` instructions. Adds the
// lanes that executed `counted` to `lanes`, also when a fault ends the launch with an Error.
void run_machine(const exec::World& world, Machine which, uint64_t instruction_budget,
                 const isa::OpRow& counted, uint64_t& lanes);

}  // namespace glint::test
