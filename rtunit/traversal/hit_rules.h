// Decides which hit counts and when a traversal ends, for visits and for shaders' answers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <tuple>

#include "rtunit/intersection/triangle_test.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::rt::rules {

inline bool has(const RayState& s, uint32_t flag) {
  return (s.ray.flags & flag) != 0;
}
inline bool ends_at_first_hit(const RayState& s) {
  return s.rules.end_at_first_hit && has(s, ray_flag::kTerminateOnFirstHit);
}

inline void finish(RayState& s) {
  s.status = RayStatus::Done;
  s.stack_size = 0;
  if (s.table) s.table->drop(s.table->used);
}

// Choice: at equal t the lowest (instance, geometry, primitive) wins, so results do not depend on the order
// of visits.
inline bool wins(const RayState& s, float t, uint32_t instance, uint32_t geometry, uint32_t primitive) {
  if (t != s.committed.t) return t < s.committed.t;
  return s.committed.valid() &&
         std::tuple(instance, geometry, primitive) <
             std::tuple(s.committed.instance, s.committed.geometry, s.committed.primitive);
}

// Takes candidates out of the table that can no longer become the hit, because the ray has become shorter
// since they were gathered.
inline void drop_beaten(RayState& s) {
  for (uint32_t rest = s.table->used; rest; rest &= rest - 1) {
    const auto row = uint32_t(std::countr_zero(rest));
    const Candidate& c = s.table->row[row];
    const bool stays = c.is_procedural ? c.hit.t <= s.committed.t
                                       : wins(s, c.hit.t, c.hit.instance, c.hit.geometry, c.hit.primitive);
    if (!stays) s.table->drop(1u << row);
  }
}

// Ends the ray when there is nothing left to visit, unless candidates wait for shaders.
inline void end_traversal(RayState& s) {
  if (s.table && s.table->used) {
    drop_beaten(s);
    if (s.table->used) {
      s.status = RayStatus::Gathered;
      return;
    }
  }
  finish(s);
}

// Drops entries that cannot matter any more and leaves a finished bottom level, so that the top entry is the
// next node. An entry at exactly the committed distance stays, because its primitive may win the tie.
inline void settle(RayState& s) {
  for (;;) {
    if (s.stack_size == s.bottom_stack_base) [[unlikely]] {
      s.bottom_stack_base = -1;
      s.base = s.ray.structure;
      s.instance_leaf = 0;
      enter_space(s.space, s.ray.origin, s.ray.direction);
    }
    if (s.stack_size == 0) [[unlikely]]
      return end_traversal(s);
    if (!s.rules.retest || s.stack[size_t(s.stack_size) - 1].t_enter <= s.committed.t) return;
    --s.stack_size;
  }
}

}  // namespace glint::rt::rules
