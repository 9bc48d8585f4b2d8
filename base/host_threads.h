// Says how many threads of the host stand for a wanted number.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <thread>

namespace glint {

// Returns the number of threads that stand for `wanted`: as many as the host has processors for 0.
inline uint32_t host_threads(uint32_t wanted) {
  return wanted ? wanted : std::max(1u, std::thread::hardware_concurrency());
}

}  // namespace glint
