// Declares the interface of the policies that choose the order in which a ray visits the children of a node.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "base/registry.h"
#include "rtunit/intersection/ray_space.h"
#include "rtunit/structure/structure.h"
#include "rtunit/traversal/ray.h"

namespace glint::rt {

// Shows an order the ray that visits a node.
struct RayView {
  const Ray& ray;          // as the shader handed it over, with its flags; it is in world space
  const RaySpace& space;   // the ray in the space of the node's boxes
  float t_max;             // distance of the hit so far, or where the ray ends
  bool ends_at_first_hit;  // The first hit that is found ends the ray, so any hit is as good as the nearest.
};

// Lists the children of one node that the ray enters, in index order.
struct ChildHits {
  int count = 0;
  const float* t_enter = nullptr;
  const NodeRef* child = nullptr;
  const uint8_t* slot = nullptr;  // where each lies in the node
  uint32_t octant = 0;            // bit a: the ray's direction along axis a is negative
  const RayView* ray = nullptr;
  // Holds the node's bytes, and what reads boxes from them. Only an order that calls boxes() pays for them.
  const std::byte* node = nullptr;
  void (*read_boxes)(const ChildHits& hits, Bounds* out) = nullptr;

  // Writes the box of each of the `count` children to `out`, as the traversal sees it.
  void boxes(Bounds* out) const { read_boxes(*this, out); }
};

// Contract (tests/contract/rt_child_order_test.cpp):
//  - sort() writes each of 0 .. hits.count - 1 to `order` once; order[0] is the child to be visited first.
//  - The choice depends on the argument alone: an order has no state and serves all rays.
//  - sort() may rely on every member of `hits`; nearest_first() reads `count` and `t_enter` only.
class ChildOrder {
 public:
  static constexpr PolicyKind kKind{"rt.child_order", "rtunit/child_orders"};
  struct Context {};
  virtual ~ChildOrder() = default;
  virtual void sort(const ChildHits& hits, uint8_t* order) const = 0;
  // Returns whether the order means something only for slots by octant (NodeFormat::has_octant_slots()).
  virtual bool needs_octant_slots() const { return false; }
  // Returns the order that rays are told to use. Null stands for nearest_first(), which is compiled into the
  // traversal.
  virtual const ChildOrder* for_rays() const { return this; }
};

// Sorts by distance. Of two children at the same distance, the one with the lower index comes first.
inline void nearest_first(const ChildHits& hits, uint8_t* order) {
  for (int i = 0; i < hits.count; ++i) {
    int at = i;
    for (; at > 0 && hits.t_enter[i] < hits.t_enter[order[at - 1]]; --at) order[at] = order[at - 1];
    order[at] = uint8_t(i);
  }
}

}  // namespace glint::rt
