// Holds what the visits of nodes share, whatever their format.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "rtunit/structure/structure.h"
#include "rtunit/traversal/hit_rules.h"
#include "rtunit/traversal/traversal.h"

namespace glint::rt::rules {

inline void push(RayState& s, NodeRef node, float t_enter) {
  if (s.stack_size >= kStackEntries) [[unlikely]]
    return break_off(s);  // Only a structure that a shader has overwritten is that deep.
  if (s.path) [[unlikely]]
    s.path->parent[size_t(s.stack_size)] = s.path->depth;
  s.stack.set(size_t(s.stack_size++), {node, t_enter});
  if (s.stack_size > s.stack_peak) s.stack_peak = s.stack_size;
}

inline bool culled_by_kind(const RayState& s, NodeKind kind) {
  return (kind == NodeKind::Triangle && has(s, ray_flag::kSkipTriangles)) ||
         (kind == NodeKind::Procedural && has(s, ray_flag::kSkipAabbs));
}

// Visits the leaf whose bytes are given and whose entry has just left the stack.
void visit_leaf(RayState& s, const std::byte* bytes, const StackEntry& entry, NodeKind kind);

}  // namespace glint::rt::rules
