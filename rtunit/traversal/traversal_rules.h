// Decides what Vulkan leaves open about a ray's way through a structure. None of it changes which hit is
// nearest.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "rtunit/child_order.h"

namespace glint::rt {

struct TraversalRules {
  // Says whether kTerminateOnFirstHit ends the ray at the first hit that is found, or only once no nearer hit
  // is possible. It is set before begin().
  bool end_at_first_hit = true;
  bool in_code = false;  // A program walks the ray, so its stack is not in RayState.
  // The RT unit that walks the ray sets these; begin() sets them to the values here.
  bool retest = true;                 // Entries behind the hit are dropped when they come up, not visited.
  const ChildOrder* order = nullptr;  // null: nearest_first()
};

}  // namespace glint::rt
