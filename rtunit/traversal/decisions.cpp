// Applies a shader's answer to a candidate to the ray (Vulkan 1.3, chapter "Ray Traversal").
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/traversal/hit_rules.h"
#include "rtunit/traversal/traversal.h"

namespace glint::rt {

using namespace rules;

namespace {

// Goes on after a candidate has been decided: with the next one of the table, or with the next node.
void go_on(RayState& s) {
  if (s.table && s.table->used) {
    drop_beaten(s);
    if (s.table->used) {
      s.status = RayStatus::Gathered;
      return;
    }
  }
  s.status = RayStatus::Traversing;
  if (!s.rules.in_code) settle(s);
}

// Makes the accepted candidate the hit. The ray goes on, or ends when it asked for any hit.
void commit(RayState& s, bool end) {
  s.committed = s.candidate;
  end = end || ends_at_first_hit(s);
  s.terminated = end;
  if (s.candidate_procedural) {
    s.attribute_slot = !s.attribute_slot;
    s.report_accepted = true;
    s.status = RayStatus::NeedsIntersection;  // The intersection shader runs on.
  } else if (end) {
    finish(s);
  } else {
    go_on(s);
  }
}

bool is_same_primitive(const Hit& a, const Hit& b) {
  return a.instance == b.instance && a.geometry == b.geometry && a.primitive == b.primitive;
}

}  // namespace

void accept_candidate(RayState& s) {
  commit(s, false);
}
void terminate_candidate(RayState& s) {
  commit(s, true);
}

void ignore_candidate(RayState& s) {
  if (s.candidate_procedural) {
    s.report_accepted = false;
    s.status = RayStatus::NeedsIntersection;
    return;
  }
  go_on(s);
}

Report report(RayState& s, float t, uint32_t kind) {
  s.report_accepted = false;
  // For hits that shaders report, the interval includes both ends (Vulkan, "Ray Intersection Candidate
  // Determination"), so a primitive may report its own hit again.
  const bool at_end_of_ray =
      t == s.committed.t && (!s.committed.valid() || is_same_primitive(s.committed, s.candidate));
  // The first accepted report ends the intersection shader, though a nearer primitive may still be looked
  // for.
  const bool is_over =
      s.terminated || (has(s, ray_flag::kTerminateOnFirstHit) && is_same_primitive(s.committed, s.candidate));
  if (is_over || !(t >= s.ray.t_min) ||
      !(at_end_of_ray || wins(s, t, s.candidate.instance, s.candidate.geometry, s.candidate.primitive)))
    return Report::Rejected;
  s.candidate.t = t;
  s.candidate.kind = kind;
  if (!s.candidate_opaque) {
    s.status = RayStatus::NeedsAnyHit;
    return Report::NeedsAnyHit;
  }
  commit(s, false);
  return Report::Accepted;
}

void finish_intersection(RayState& s) {
  if (s.terminated) return finish(s);
  go_on(s);
}

}  // namespace glint::rt
