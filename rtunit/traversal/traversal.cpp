// Walks a ray by Vulkan's rules, node by node (Vulkan 1.3, chapter "Ray Traversal").
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/traversal/traversal.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "rtunit/intersection/box_test.h"
#include "rtunit/intersection/triangle_test.h"
#include "rtunit/leaf_filter.h"
#include "rtunit/node_format.h"
#include "rtunit/traversal/visit_rules.h"

namespace glint::rt {

using namespace rules;

namespace {

// Returns whether the ray goes on past the candidate that it has just met.
bool passes(RayState& s, RayStatus needed) {
  if (!s.table) {
    s.status = needed;
    return false;
  }
  s.table->add({s.candidate, s.candidate_procedural, s.candidate_opaque});
  if (s.table->is_full()) drop_beaten(s);
  return !s.table->is_full();
}

// Enters the instance whose leaf lies at `at`. The node of its structure is the ray's next one.
void enter_instance(RayState& s, const InstanceLeaf& leaf, Address at, const StackEntry& next) {
  const auto& m = leaf.world_to_object;
  const auto& o = s.ray.origin;
  const auto& d = s.ray.direction;
  std::array<float, 3> origin, direction;  // They are not normalised, so t is the same in both spaces.
  for (size_t r = 0; r < 3; ++r) {
    origin[r] = ((m[4 * r] * o[0] + m[4 * r + 1] * o[1]) + m[4 * r + 2] * o[2]) + m[4 * r + 3];
    direction[r] = (m[4 * r] * d[0] + m[4 * r + 1] * d[1]) + m[4 * r + 2] * d[2];
  }
  enter_space(s.space, origin, direction);
  s.instance_leaf = at;
  s.base = leaf.structure;
  s.instance = leaf.instance;
  s.instance_flags = leaf.flags();
  s.instance_custom_index = leaf.custom_index();
  s.instance_sbt_record = leaf.sbt_offset();
  s.bottom_stack_base = s.stack_size;
  push(s, next.node, next.t_enter);
}

void visit_instance(RayState& s, const std::byte* bytes, const StackEntry& entry) {
  const auto leaf = load<InstanceLeaf>(bytes);
  ++s.instances_visited;
  if ((leaf.mask() & s.ray.cull_mask) == 0) return;
  enter_instance(s, leaf, s.base + Address(block_of(entry.node)) * kBlockBytes,
                 {node_ref(kRootBlock, NodeKind::Internal), entry.t_enter});
}

// The instance's flags override the geometry's, and the ray's flags override both.
bool is_opaque(const RayState& s, bool geometry_opaque) {
  bool opaque = geometry_opaque;
  if (s.instance_flags & instance_flag::kForceOpaque) opaque = true;
  if (s.instance_flags & instance_flag::kForceNoOpaque) opaque = false;
  if (has(s, ray_flag::kOpaque)) opaque = true;
  if (has(s, ray_flag::kNoOpaque)) opaque = false;
  return opaque;
}

bool culled_by_opacity(const RayState& s, bool opaque) {
  return has(s, opaque ? ray_flag::kCullOpaque : ray_flag::kCullNoOpaque);
}

Opacity look_up(const RayState& s, const TriangleLeaf& leaf, uint32_t number) {
  const bool two_states =
      has(s, ray_flag::kForceMicromaps2State) || (s.instance_flags & instance_flag::kForceMicromaps2State);
  return s.filter->look_up({leaf, number, s.candidate, s.base, two_states}).opacity;
}

// Asks the filter, if there is one, about the ray's candidate, which is not opaque.
// Choice: what is forced to be opaque is so where its map is transparent, too, and culling by opacity goes by
// the geometry, so that baked maps with 4 states change no picture. In Vulkan the maps come first.
Opacity filtered(const RayState& s, const TriangleLeaf& leaf, uint32_t number) {
  if (!s.filter || (s.instance_flags & instance_flag::kDisableMicromaps)) [[likely]]
    return Opacity::Unknown;
  const Opacity opacity = look_up(s, leaf, number);
  const bool is_forced = has(s, ray_flag::kNoOpaque) || s.instance_flags & instance_flag::kForceNoOpaque;
  return opacity == Opacity::Opaque && is_forced ? Opacity::Unknown : opacity;
}

bool has_maps_first(const RayState& s, const TriangleLeaf& leaf) {
  return leaf.has_maps_first() && s.filter && !(s.instance_flags & instance_flag::kDisableMicromaps);
}

// Says what becomes of the ray's candidate where maps come first: the ray passes transparent parts whatever
// is forced, and what a map says stands for the geometry's opacity. Culled ones count as transparent.
Opacity decided_by_map(const RayState& s, const TriangleLeaf& leaf, uint32_t number) {
  const Opacity opacity = look_up(s, leaf, number);
  if (opacity == Opacity::Transparent) return opacity;
  const bool opaque = is_opaque(s, opacity == Opacity::Opaque);
  if (culled_by_opacity(s, opaque)) return Opacity::Transparent;
  return opaque ? Opacity::Opaque : Opacity::Unknown;
}

Hit candidate_of(const RayState& s, uint32_t geometry, uint32_t primitive) {
  Hit hit;
  hit.instance = s.instance;
  hit.geometry = geometry;
  hit.primitive = primitive;
  hit.custom_index = s.instance_custom_index;
  hit.sbt_record = s.instance_sbt_record;
  hit.instance_leaf = s.instance_leaf;
  return hit;
}

// Facing culls only triangles, and the instance can disable it (Vulkan, "Ray Face Culling").
bool culled_by_facing(const RayState& s, bool front) {
  if (s.instance_flags & instance_flag::kFacingCullDisable) return false;
  return has(s, front ? ray_flag::kCullFrontFacing : ray_flag::kCullBackFacing);
}

void visit_triangles(RayState& s, const std::byte* bytes, const StackEntry& entry) {
  const auto leaf = load<TriangleLeaf>(bytes);
  const bool resumed = kind_of(entry.node) == NodeKind::TriangleSecond;
  if (!resumed) ++s.leaves_visited;
  const bool opaque = is_opaque(s, leaf.opaque != 0), maps_first = has_maps_first(s, leaf);
  if (!maps_first && culled_by_opacity(s, opaque)) return;
  for (uint32_t i = resumed ? 1 : 0; i < leaf.count && i < 2; ++i) {
    const uint32_t a = i ? leaf.second & 3 : 0, b = i ? leaf.second >> 2 & 3 : 1,
                   c = i ? leaf.second >> 4 & 3 : 2;
    ++s.triangle_tests;
    TriangleHit found;
    if (!intersect_triangle(s.space, leaf.vertex[a], leaf.vertex[b], leaf.vertex[c], found)) continue;
    const bool front = found.front != ((s.instance_flags & instance_flag::kFlipFacing) != 0);
    if (culled_by_facing(s, front)) continue;
    // The interval is open at both ends, also when a box's hit lies at the far one.
    const bool inside = found.t > s.ray.t_min && found.t < s.ray.t_max;
    s.hits_in_interval += inside;
    if (!inside || !wins(s, found.t, s.instance, leaf.geometry, leaf.primitive_of(i))) continue;
    s.candidate = candidate_of(s, leaf.geometry, leaf.primitive_of(i));
    s.candidate.triangle_leaf = s.base + Address(block_of(entry.node)) * kBlockBytes;
    s.candidate.t = found.t;
    s.candidate.u = found.u;
    s.candidate.v = found.v;
    s.candidate.kind = front ? kHitKindFront : kHitKindBack;
    const Opacity opacity = maps_first ? decided_by_map(s, leaf, i)
                            : opaque   ? Opacity::Opaque
                                       : filtered(s, leaf, i);
    if (opacity == Opacity::Transparent) continue;
    if (opacity == Opacity::Unknown) {
      s.candidate_procedural = false;
      if (passes(s, RayStatus::NeedsAnyHit)) continue;
      if (i == 0 && leaf.count > 1)
        push(s, node_ref(block_of(entry.node), NodeKind::TriangleSecond), entry.t_enter);
      return;
    }
    s.committed = s.candidate;
    if (ends_at_first_hit(s)) return finish(s);
  }
}

void visit_procedural(RayState& s, const std::byte* bytes) {
  const auto leaf = load<ProceduralLeaf>(bytes);
  ++s.leaves_visited;
  ++s.box_tests;
  const bool opaque = is_opaque(s, leaf.opaque != 0);
  if (culled_by_opacity(s, opaque)) return;
  float t_near = -__builtin_inff(), t_far = __builtin_inff();
  for (size_t a = 0; a < 3; ++a) {
    const bool backward = std::signbit(s.space.inverse_direction[a]);
    clip_slab(backward ? leaf.box.high[a] : leaf.box.low[a], backward ? leaf.box.low[a] : leaf.box.high[a],
              s.space.origin[a], s.space.inverse_direction[a], t_near, t_far);
  }
  const float enter = std::fmax(widen_near(t_near), s.ray.t_min),
              leave = std::fmin(widen_far(t_far), s.committed.t);
  if (!(enter <= leave)) return;
  s.candidate = candidate_of(s, leaf.geometry, leaf.primitive);
  s.candidate.t = enter;
  s.candidate_procedural = true;
  s.candidate_opaque = opaque;
  passes(s, RayStatus::NeedsIntersection);
}

}  // namespace

void rules::visit_leaf(RayState& s, const std::byte* bytes, const StackEntry& entry, NodeKind kind) {
  switch (kind) {
    case NodeKind::Instance:
      return visit_instance(s, bytes, entry);
    case NodeKind::Triangle:
    case NodeKind::TriangleSecond:
      return visit_triangles(s, bytes, entry);
    case NodeKind::Procedural:
      return visit_procedural(s, bytes);
    default:
      return break_off(s);  // The reference comes from a structure that a shader has overwritten.
  }
}

namespace {

bool is_finite(const std::array<float, 3>& v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

}  // namespace

bool begin(RayState& s, const mem::AddressSpace& memory) {
  s.committed = Hit{};
  s.committed.t = s.ray.t_max;
  s.candidate = Hit{};
  s.candidate_procedural = s.candidate_opaque = s.attribute_slot = s.report_accepted = s.terminated =
      s.broken = false;
  s.instance_leaf = 0;
  s.instance = kNoHit;
  s.instance_flags = s.instance_custom_index = s.instance_sbt_record = 0;
  s.stack_size = s.stack_peak = s.stack_off_chip = s.stack_in_memory = 0;
  s.rules.retest = true;
  s.rules.order = nullptr;
  s.path = nullptr;
  s.bottom_stack_base = -1;
  s.nodes_visited = s.box_tests = s.triangle_tests = s.leaves_visited = s.instances_visited =
      s.hits_in_interval = 0;
  if (s.table) s.table->clear();
  s.status = RayStatus::Done;
  if (s.ray.structure == 0) return true;
  const auto* bytes = memory.find(s.ray.structure, sizeof(StructureHeader));
  if (!bytes) return false;
  const auto header = load<StructureHeader>(bytes);
  if (header.magic != StructureHeader::kMagic || header.level != 1) return false;
  const NodeFormat* format = find_format(header.format);
  if (!format) return false;
  const bool sane = is_finite(s.ray.origin) && is_finite(s.ray.direction) && std::isfinite(s.ray.t_min) &&
                    s.ray.t_min <= s.ray.t_max;
  if (!sane) return true;
  s.walk = &format->walk();
  s.node_bytes = uint8_t(s.walk->node_bytes);
  s.base = s.ray.structure;
  enter_space(s.space, s.ray.origin, s.ray.direction);
  s.status = RayStatus::Traversing;
  push(s, node_ref(kRootBlock, NodeKind::Internal), s.ray.t_min);
  return true;
}

void step(RayState& s, const std::byte* bytes) {
  s.walk->step(s, bytes);
}

bool start_at(RayState& s, const mem::AddressSpace& memory, const Start& start) {
  GLINT_DCHECK(s.nodes_visited == 0 && s.stack_size == 1, "the ray has begun its walk already");
  const std::byte* bytes = memory.find(start.instance_leaf, sizeof(InstanceLeaf));
  if (!bytes) return false;
  const auto leaf = load<InstanceLeaf>(bytes);
  const std::byte* below = memory.find(leaf.structure, sizeof(StructureHeader));
  if (!below || (leaf.mask() & s.ray.cull_mask) == 0 || culled_by_kind(s, start.kind)) return false;
  const auto header = load<StructureHeader>(below);
  const Address offset = start.node - leaf.structure;  // more than any structure has for a node before it
  const bool fits = header.magic == StructureHeader::kMagic && header.level == 0 &&
                    header.format == s.walk->format && header.stack_need < kStackEntries &&
                    offset % kBlockBytes == 0 && offset < std::min(header.bytes, kMostBytes);
  if (!fits) return false;
  ++s.instances_visited;
  enter_instance(s, leaf, start.instance_leaf,
                 {node_ref(uint32_t(offset / kBlockBytes), start.kind), s.ray.t_min});
  return true;
}

void break_off(RayState& s) {
  s.broken = true;
  finish(s);
}

void run(RayState& s, const mem::AddressSpace& memory) {
  s.walk->run(s, memory);
}

}  // namespace glint::rt
