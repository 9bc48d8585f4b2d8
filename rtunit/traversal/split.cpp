// Moves entries of a ray's stack to a part of the ray, and what the part finds back.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/traversal/split.h"

#include "base/check.h"
#include "rtunit/structure/structure.h"
#include "rtunit/traversal/hit_rules.h"

namespace glint::rt {
namespace {

// A part counts from here, because a ray without visits would be taken for one that has not begun.
void clear_counts(RayState& part) {
  part.nodes_visited = 1;
  part.box_tests = part.triangle_tests = part.hits_in_interval = 0;
  part.leaves_visited = part.instances_visited = 0;
}

void remove_entry(RayState& s, size_t entry) {
  for (size_t i = entry; i + 1 < size_t(s.stack_size); ++i) {
    s.stack.set(i, s.stack[i + 1]);
    if (s.path) s.path->parent[i] = s.path->parent[i + 1];
  }
  --s.stack_size;
  if (int(entry) < s.bottom_stack_base) --s.bottom_stack_base;
}

}  // namespace

void split_off(RayState& from, size_t entry, RayState& part) {
  GLINT_DCHECK(int(entry) + 1 < from.stack_size, "entry {} of {} is the ray's next", entry, from.stack_size);
  const bool in_top_level = int(entry) < from.bottom_stack_base;
  part.ray = from.ray;
  part.rules = from.rules;
  part.walk = from.walk;
  part.node_bytes = from.node_bytes;
  part.committed = from.committed;
  part.status = RayStatus::Traversing;
  part.table = nullptr;
  part.path = nullptr;
  part.broken = part.terminated = false;
  part.stack.set(0, from.stack[entry]);
  part.stack_size = part.stack_peak = 1;
  part.stack_off_chip = part.stack_in_memory = 0;
  part.bottom_stack_base = -1;
  part.base = from.ray.structure;
  part.instance_leaf = 0;
  if (!in_top_level && from.bottom_stack_base >= 0) {
    part.bottom_stack_base = 0;
    part.base = from.base;
    part.space = from.space;
    part.instance_leaf = from.instance_leaf;
    part.instance = from.instance;
    part.instance_flags = from.instance_flags;
    part.instance_custom_index = from.instance_custom_index;
    part.instance_sbt_record = from.instance_sbt_record;
  } else {
    enter_space(part.space, from.ray.origin, from.ray.direction);
  }
  clear_counts(part);
  remove_entry(from, entry);
  rules::settle(part);
}

bool merge_part(RayState& part, RayState& ray) {
  ray.nodes_visited += part.nodes_visited - 1;
  ray.box_tests += part.box_tests;
  ray.triangle_tests += part.triangle_tests;
  ray.hits_in_interval += part.hits_in_interval;
  ray.leaves_visited += part.leaves_visited;
  ray.instances_visited += part.instances_visited;
  clear_counts(part);
  ray.broken |= part.broken;
  const Hit& found = part.committed;
  if (!found.valid() || !rules::wins(ray, found.t, found.instance, found.geometry, found.primitive))
    return false;
  ray.committed = found;
  return true;
}

void cancel(RayState& state) {
  rules::finish(state);
}

bool needs_no_shader(const RayState& state, const mem::AddressSpace& memory) {
  const std::byte* bytes = memory.find(state.ray.structure, sizeof(StructureHeader));
  if (!bytes || rules::has(state, ray_flag::kNoOpaque)) return false;
  const uint8_t held = load<StructureHeader>(bytes).contents;
  const bool skips_not_opaque = rules::has(state, ray_flag::kOpaque | ray_flag::kCullNoOpaque);
  return (!(held & contents::kNotOpaque) || skips_not_opaque) &&
         (!(held & contents::kProcedural) || rules::has(state, ray_flag::kSkipAabbs));
}

}  // namespace glint::rt
