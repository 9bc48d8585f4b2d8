// Runs some blocks of a launch functionally to see what they cost.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "exec/fault.h"
#include "exec/launch.h"
#include "pipeline/sampling/estimates.h"
#include "pipeline/sampling/sample_plan.h"

namespace glint::pipeline {

// Runs the blocks of the survey, and fills in what they cost: the nodes that their rays visit, or, in a
// launch without rays, their instructions. Returns what they did. Faults that were let pass are added to
// `passed`. Throws Error(Exit::Fault) as run_functional() does.
std::vector<BlockWork> run_survey(const exec::World& world, uint64_t instruction_budget, Survey& survey,
                                  exec::FaultLog& passed);

}  // namespace glint::pipeline
