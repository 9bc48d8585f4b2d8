// The traversal state of one ray: what a lane of the RT unit's warp buffer holds.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "rtunit/ray.h"

namespace glint::rt {

inline constexpr int kStackEntries = 96;  // full stack; checked against the structure's depth at build

// One node still to be visited: where it is and where the ray enters it.
struct StackEntry {
  uint32_t node = 0;    // byte offset / 64 from the base of the structure being walked, and kind in low bits as the format defines
  float t_enter = 0;
};

// Plain data: may be copied and compared. The functions live in rtunit/traversal.h.
struct RayState {
  Ray ray;
  RayStatus status = RayStatus::Idle;
  Hit committed;                         // t = t_max until a hit is confirmed
  Hit candidate;                         // while NeedsIntersection or NeedsAnyHit
  bool attribute_slot = false;           // which of the two attribute buffers holds the committed attributes
  bool report_accepted = false;          // result of the last rt.report
  bool terminated = false;               // rt.terminate or terminate-on-first-hit: finish after this shader

  // The space being walked: the world, or the object space of `instance_leaf`.
  std::array<float, 3> origin{}, direction{}, inverse_direction{};
  Address base = 0;                      // virtual address of node 0 of the structure being walked
  Address instance_leaf = 0;             // 0 in the top level
  uint32_t instance = kNoHit;
  uint32_t instance_flags = 0, instance_custom_index = 0, instance_sbt_record = 0;
  int8_t stack_size = 0, bottom_stack_base = -1;  // entries below bottom_stack_base belong to the top level
  std::array<StackEntry, kStackEntries> stack;

  // Where traversal stands inside a leaf that holds several primitives.
  uint32_t leaf_cursor = 0;

  // Counted by the traversal, for probes and statistics.
  uint32_t nodes_visited = 0, box_tests = 0, triangle_tests = 0, leaves_visited = 0, instances_visited = 0;
};

}  // namespace glint::rt
