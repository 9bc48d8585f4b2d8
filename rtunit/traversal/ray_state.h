// Holds the traversal state of one ray, which a lane of the RT unit's warp buffer keeps.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "rtunit/intersection/ray_space.h"
#include "rtunit/traversal/candidate_table.h"
#include "rtunit/traversal/ray.h"
#include "rtunit/traversal/ray_path.h"
#include "rtunit/traversal/ray_stack.h"
#include "rtunit/traversal/traversal_rules.h"

namespace glint::rt {

class LeafFilter;
struct NodeWalk;

// Holds data only and may be copied. The functions that work on it are in rtunit/traversal/traversal.h. What
// a visit of a node needs lies together in the first cache lines of the host.
struct alignas(64) RayState {
  Ray ray;
  RaySpace space;                                  // the world, or the object space of `instance_leaf`
  int16_t stack_size = 0, bottom_stack_base = -1;  // Entries below bottom_stack_base belong to the top level.
  int16_t stack_peak = 0;
  // The RT unit does not hold this number of entries at the bottom. The stack model sets it.
  int16_t stack_off_chip = 0;
  int16_t stack_in_memory = 0;  // This number of those entries lie in memory. The stack model sets it.
  RayStatus status = RayStatus::Idle;
  uint8_t node_bytes = 0;  // size of its internal nodes
  Address base = 0;        // virtual address of the header of the structure being walked
  // The ray gathers its candidates here. With null it stops at each. The owner sets it before begin().
  CandidateTable* table = nullptr;
  // The RT unit sets this when its stack model needs a path; begin() sets null.
  RayPath* path = nullptr;
  const NodeWalk* walk = nullptr;  // of the structure's node format (rtunit/node_format.h)
  TraversalRules rules;
  // The traversal counts these for probes and statistics.
  uint32_t nodes_visited = 0, box_tests = 0, triangle_tests = 0;
  // Counts triangles met within the ray's interval, whether or not they are nearer than the hit so far.
  uint32_t hits_in_interval = 0;
  Hit committed;   // Its t is t_max until a hit is confirmed.
  RayStack stack;  // Entries below stack_size are valid.

  Hit candidate;                      // It is valid while NeedsIntersection or NeedsAnyHit.
  bool candidate_procedural = false;  // The candidate came from an AABB: its attributes are in memory.
  bool candidate_opaque = false;  // While NeedsIntersection: a report is confirmed without an any-hit shader.
  bool attribute_slot = false;    // which of the two attribute buffers holds the committed attributes
  bool report_accepted = false;   // result of the last rt.report
  bool broken = false;      // The structure's bytes led outside memory, and the ray ended without a meaning.
  bool terminated = false;  // After rt.terminate or terminate-on-first-hit the ray ends after this shader.
  uint8_t candidate_row = 0;  // row of the table that the candidate came from

  Address instance_leaf = 0;  // 0 in the top level
  uint32_t instance = kNoHit;
  uint32_t instance_flags = 0, instance_custom_index = 0, instance_sbt_record = 0;
  uint32_t leaves_visited = 0, instances_visited = 0;
  uint64_t unit_cycles = 0;  // cycles in the RT unit over all stays; the unit sets it from the first stay on
  // It decides triangles that would need an any-hit shader. Null: shaders decide. It is set before begin().
  const LeafFilter* filter = nullptr;
};

// Brings what a visit of a node needs of a ray near to the host's core.
inline void prefetch(const RayState& s) {
  __builtin_prefetch(&s.space);
  __builtin_prefetch(&s.base);
  __builtin_prefetch(&s.stack);
}

// Returns whether the ray ended with entries left that nobody looks at any more.
inline bool has_left_stack(const RayState& s) {
  return s.status == RayStatus::Done &&
         (s.broken || s.terminated ||
          (s.rules.end_at_first_hit && (s.ray.flags & ray_flag::kTerminateOnFirstHit) &&
           s.committed.valid()));
}

}  // namespace glint::rt
