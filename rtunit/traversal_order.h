// Declares the interface of the policies that choose which of a ray's open nodes it visits next.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include "base/registry.h"
#include "base/stats.h"
#include "memsys/address_space.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::rt {

// Lists the nodes that a ray still has to visit in the structure that it walks, after a visit. They are
// entries of its stack, which the ray visits from the top down. Those of a structure above lie below them and
// come later, whatever the order.
struct OpenNodes {
  RayState& ray;
  Fetch visited;      // the node that the ray visited last
  size_t bottom = 0;  // lowest entry of this structure
  size_t first = 0;   // The visit has pushed the entries from here to the top. The next one is on top.
  size_t end = 0;     // number of entries of the stack
};

// Contract (tests/contract/rt_traversal_order_test.cpp):
//  - arrange() may put the entries from `bottom` on into another order, and changes nothing else.
//  - What it does depends on the calls alone, and not on how many cycles lie between two of them.
//  - No order changes a hit: the nearest wins, whichever is found first.
class TraversalOrder {
 public:
  static constexpr PolicyKind kKind{"rt.order", "rtunit/orders"};
  static constexpr std::string_view kDepthFirst = "depth_first";  // Under this name nothing is rearranged.
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
    const mem::AddressSpace& memory;
  };
  virtual ~TraversalOrder() = default;
  // Returns whether the order goes by treelets, which not every layout forms (bvh.layout).
  virtual bool needs_treelets() const { return false; }
  // Puts the nodes into the order in which the ray is to visit them. It is called after each visit of an
  // internal node, unless the ray's stack might not have room for its open nodes in any order but depth
  // first.
  virtual void arrange(const OpenNodes&) {}
};

// Moves the entries [first, end) of a stack below those of [to, first). Both keep their own order.
inline void move_below(RayStack& stack, size_t to, size_t first, size_t end) {
  std::array<StackEntry, kStackEntries> above;
  for (size_t i = to; i < first; ++i) above[i - to] = stack[i];
  for (size_t i = first; i < end; ++i) stack.set(to + i - first, stack[i]);
  for (size_t i = to; i < first; ++i) stack.set(i + end - first, above[i - to]);
}

}  // namespace glint::rt
