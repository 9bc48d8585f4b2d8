// Compiles the traversal for a node format. The format's own file includes this header, so that a visit costs
// no call through a pointer.
//
// `class Name final : public FormatOf<Name>` has kName, kDoc and Params as every policy, the functions that
// NodeFormat leaves open, and:
//  - kWidth: the largest number of children of a node.
//  - kNodeBytes: bytes of a node, a multiple of kBlockBytes below 256.
//  - kPlanes: the number of distances that test() writes, a multiple of four.
//  - References: made of a node's bytes, it has the reference of child i as [i].
//  - static uint32_t test(const std::byte* node, const RaySpace& space, float t_min, float t_max,
//                         float* t_enter, uint32_t& box_tests)
//    returns a mask of the children that the ray enters in [t_min, t_max], writes where it does to
//    t_enter[i], and adds the number of the node's children to box_tests. It has to use
//    rtunit/intersection/box_test.h, whose margins keep ties independent of the order of visits.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "rtunit/child_order.h"
#include "rtunit/intersection/four.h"
#include "rtunit/node_format.h"
#include "rtunit/traversal/visit_rules.h"

namespace glint::rt {
namespace rules {

// Returns the children of `entered` whose kinds the ray does not skip.
template <class References>
uint32_t without_skipped(const RayState& s, uint32_t entered, const References& child) {
  uint32_t out = 0;
  for (uint32_t rest = entered; rest; rest &= rest - 1)
    if (!culled_by_kind(s, kind_of(child[std::countr_zero(rest)]))) out |= rest & -rest;
  return out;
}

// Pushes the children with the nearest on top. Of two at the same distance, the one with the lower index
// comes above the other. `top` is where the ray's next entry lies.
template <class References>
void push_nearest_first(RayState& s, StackEntry* top, uint32_t entered, const float* t_enter,
                        const References& child) {
  int count = 0;
  for (uint32_t rest = entered; rest; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    int at = count++;
    for (; at > 0 && top[at - 1].t_enter <= t_enter[i]; --at) top[at] = top[at - 1];
    top[at] = {child[i], t_enter[i]};
  }
  s.stack_size = int16_t(s.stack_size + count);
  s.stack_peak = std::max(s.stack_peak, s.stack_size);
}

// Returns a bit for each axis along which the ray's direction is negative.
inline uint32_t octant_of(const RaySpace& space) {
  uint32_t out = 0;
  for (size_t a = 0; a < 3; ++a) out |= uint32_t(std::signbit(space.direction[a])) << a;
  return out;
}

// Writes the boxes of the children that are hit. Both lists of children are in the order of the node.
template <class Format>
void read_boxes(const ChildHits& hits, Bounds* out) {
  static const Format format({}, {});
  DecodedChild decoded[Format::kWidth];
  const uint32_t count = format.decode(hits.node, decoded);
  int at = 0;
  for (uint32_t i = 0; i < count && at < hits.count; ++i)
    if (decoded[i].node == hits.child[at]) out[at++] = decoded[i].bounds;
}

// Pushes the children in the order that `sort` says.
template <class Format, class Sort>
void push_sorted(RayState& s, uint32_t entered, const float* t_enter,
                 const typename Format::References& child, Sort&& sort) {
  float t[Format::kWidth];
  NodeRef node[Format::kWidth];
  uint8_t slot[Format::kWidth];
  int hits = 0;
  for (uint32_t rest = entered; rest; rest &= rest - 1, ++hits) {
    const int i = std::countr_zero(rest);
    t[hits] = t_enter[i];
    node[hits] = child[i];
    slot[hits] = uint8_t(i);
  }
  uint8_t order[Format::kWidth];
  sort(ChildHits{hits, t, node, slot}, order);
  for (int i = hits - 1; i >= 0; --i) push(s, node[order[i]], t[order[i]]);  // The first is on top.
}

// Returns the children that the ray enters, and writes where it enters each of them to `t_enter`.
template <class Format>
[[gnu::always_inline]] inline uint32_t entered_children(RayState& s, const std::byte* bytes, float* t_enter) {
  const uint32_t entered = Format::test(bytes, s.space, s.ray.t_min, s.committed.t, t_enter, s.box_tests);
  if (has(s, ray_flag::kSkipTriangles | ray_flag::kSkipAabbs)) [[unlikely]]
    return without_skipped(s, entered, typename Format::References(bytes));
  return entered;
}

// Visits a node whose children the ray's rules order. It is a function of its own, so that visit_internal()
// stays as small as it is without such rules.
template <class Format>
[[gnu::noinline]] void visit_by_order(RayState& s, const std::byte* bytes) {
  alignas(Four) float t_enter[Format::kPlanes];
  const uint32_t entered = entered_children<Format>(s, bytes, t_enter);
  push_sorted<Format>(s, entered, t_enter, typename Format::References(bytes),
                      [&](ChildHits hits, uint8_t* order) {
                        const RayView ray{s.ray, s.space, s.committed.t, ends_at_first_hit(s)};
                        hits.octant = octant_of(s.space);
                        hits.ray = &ray;
                        hits.node = bytes;
                        hits.read_boxes = read_boxes<Format>;
                        s.rules.order->sort(hits, order);
                      });
}

template <class Format>
void visit_internal(RayState& s, const std::byte* bytes) {
  if (s.rules.order) [[unlikely]]
    return visit_by_order<Format>(s, bytes);
  alignas(Four) float t_enter[Format::kPlanes];
  const uint32_t entered = entered_children<Format>(s, bytes, t_enter);
  const typename Format::References child(bytes);
  StackEntry* top = s.stack.near_room(size_t(s.stack_size), Format::kWidth);
  if (top && !s.path) [[likely]]
    push_nearest_first(s, top, entered, t_enter, child);
  else
    push_sorted<Format>(s, entered, t_enter, child, nearest_first);
}

// Notes the node that is about to be visited as the last of its depth.
inline void remember(const RayState& s, RayPath& path) {
  path.depth = uint8_t(path.parent[size_t(s.stack_size) - 1] + 1);
  path.node[path.depth] = next_fetch(s);
}

template <class Format>
void step_as(RayState& s, const std::byte* bytes) {
  if (s.path) [[unlikely]]
    remember(s, *s.path);
  const StackEntry entry = s.stack[size_t(--s.stack_size)];
  ++s.nodes_visited;
  const NodeKind kind = kind_of(entry.node);
  if (kind == NodeKind::Internal) [[likely]]
    visit_internal<Format>(s, bytes);
  else
    visit_leaf(s, bytes, entry, kind);
  if (s.status != RayStatus::Traversing) [[unlikely]]
    return;
  settle(s);
  if (s.table && s.status == RayStatus::Traversing && s.table->is_full()) [[unlikely]] {
    s.status = RayStatus::Gathered;
    ++s.table->overflows;
  }
}

template <class Format>
void run_as(RayState& s, const mem::AddressSpace& memory) {
  while (s.status == RayStatus::Traversing) {
    const Fetch fetch = next_fetch(s);
    const std::byte* bytes = memory.find(fetch.address, fetch.bytes);
    if (!bytes) [[unlikely]]
      return break_off(s);
    step_as<Format>(s, bytes);
  }
}

}  // namespace rules

template <class Format>
class FormatOf : public NodeFormat {
 public:
  uint32_t width() const final { return Format::kWidth; }
  uint32_t node_bytes() const final { return Format::kNodeBytes; }
  const NodeWalk& walk() const final {
    static_assert(Format::kWidth >= 2 && Format::kWidth <= kMaxWidth && Format::kWidth <= Format::kPlanes);
    static_assert(Format::kNodeBytes < 256 &&
                  Format::kNodeBytes % kBlockBytes == 0);  // RayState keeps it in a byte.
    static constexpr NodeWalk kWalk{format_id(Format::kName), Format::kNodeBytes, rules::step_as<Format>,
                                    rules::run_as<Format>};
    return kWalk;
  }
};

}  // namespace glint::rt
