// Says how many threads of the host stand for a wanted number.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <sched.h>
#include <thread>

namespace glint {

// Returns the number of processors that this process may use. A job of a cluster, or a container, has a part
// of the machine as a rule, and more threads than processors are slower.
inline uint32_t host_processors() {
  cpu_set_t own;
  if (sched_getaffinity(0, sizeof own, &own) == 0) return std::max(1u, uint32_t(CPU_COUNT(&own)));
  return std::max(1u, std::thread::hardware_concurrency());  // The machine has more than a set holds.
}

// Returns the number of threads that stand for `wanted`: as many as there are processors for 0.
inline uint32_t host_threads(uint32_t wanted) {
  return wanted ? wanted : host_processors();
}

}  // namespace glint
