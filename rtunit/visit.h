// Describes a visit of a node, as the parts and policies of the RT unit see it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "rtunit/traversal/ray_state.h"

namespace glint::rt {

// Tells that a ray has made the step of a node. The test of the node ends a latency later.
struct Visit {
  Cycle now = 0;
  uint32_t slot = 0;  // of the warp buffer
  int lane = 0;
  RayState& ray;  // as it is after the step: its stack holds the nodes that it still has to visit
  Fetch node;
  uint32_t hits = 0;    // triangles of the node that were met within the ray's interval
  uint32_t pushed = 0;  // entries that the step put on the stack
};

}  // namespace glint::rt
