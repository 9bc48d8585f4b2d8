// Runs some blocks of a launch functionally to see what they cost, and which lines of memory they touch.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "exec/fault.h"
#include "exec/launch.h"
#include "pipeline/params.h"
#include "pipeline/sampling/estimates.h"
#include "pipeline/sampling/sample_plan.h"

namespace glint::pipeline {

// Runs the blocks of the survey, and fills in what was asked. Where lines are asked for, blocks leave nothing
// in memory, print nothing, and may run again. A block costs the nodes that its rays visit, or, in a launch
// without rays, its instructions. Returns what they did. Faults that were let pass are added to `passed`.
// Throws Error(Exit::Fault) as run_functional() does.
std::vector<BlockWork> run_survey(const exec::World& world, const GpuParams& gpu, Survey& survey,
                                  exec::FaultLog& passed);

}  // namespace glint::pipeline
