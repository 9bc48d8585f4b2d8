// Estimates what a workload will need before it runs: memory to plan by, and relative time to order by.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "apps/glint/bench/workloads.h"
#include "compute/program.h"

namespace glint::app {

// Returns the estimated peak resident memory of a run in bytes, rather too much than too little. `from_files`
// says that the scene is original data and not generated.
uint64_t memory_estimate(const NamedWorkload& workload, uint64_t pixels, bool from_files);

// Returns the relative time of a run, in no particular unit. It serves only the order of starts and the time
// left.
double time_weight(const NamedWorkload& workload, bool timing, uint64_t pixels, uint64_t samples);

// Return the same for a compute program.
uint64_t memory_estimate(const compute::Program& program, bool small);
double time_weight(const compute::Program& program, bool small, bool timing);

// Returns the bytes that this process and its children may still take: what the system calls available, or
// what the control group has left when that is less. Returns 0 when neither is known.
uint64_t available_memory();

}  // namespace glint::app
