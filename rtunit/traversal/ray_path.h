// Holds the nodes from the root to every node that a ray still has to visit, for stacks that forget entries.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "rtunit/structure/structure.h"

namespace glint::rt {

// Names a node that is to be brought from memory.
struct Fetch {
  Address address = 0;  // virtual
  uint32_t bytes = 0;
  NodeKind kind = NodeKind::Internal;
  bool operator==(const Fetch&) const = default;
};

// The traversal keeps the path up to date for rays that have one. node[d] is the node visited last at depth
// d; entry i of the ray's stack is a child of node[parent[i]]. Depths wrap at 256, which no tree that fits a
// stack of 192 entries comes near.
struct RayPath {
  const void* ray = nullptr;  // the RayState that owns it
  static constexpr uint8_t kNoParent = 0xff;
  uint8_t depth = 0;  // depth of the node visited last
  std::array<uint8_t, 256> parent;
  std::array<Fetch, 256> node;
};

}  // namespace glint::rt
