// What a workload will need, before it runs: memory to plan by, and relative time to order by.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "apps/glint/bench/workloads.h"

namespace glint::app {

// Peak resident memory of a run in bytes, rather too much than too little. `from_files`: of original data,
// not generated.
uint64_t memory_estimate(const NamedWorkload& workload, uint64_t pixels, bool from_files);

// Relative time of a run, in any unit: for the order of starts and the time left only.
double time_weight(const NamedWorkload& workload, bool timing, uint64_t pixels, uint64_t samples);

// Memory that this process and its children may still take, bytes: what the system calls available, or what
// the control group has left when that is less. 0 = not known.
uint64_t available_memory();

}  // namespace glint::app
