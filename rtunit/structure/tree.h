// Holds a tree between its construction and its encoding.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "memsys/host_block.h"
#include "rtunit/structure/structure.h"

namespace glint::rt {

// Holds a tree as the builder hands it over. Node 0 is the root and always internal. Nodes come depth first:
// the children of a node follow each other, and what is below the first comes next. Leaves point to their
// bytes in `leaf_bytes`.
struct BuildTree {
  struct Node {
    Bounds bounds;
    uint32_t first_child = 0;  // first index in `children`, for internal nodes
    uint32_t leaf_block = 0;   // blocks from the start of leaf_bytes, for leaves
    NodeKind kind = NodeKind::Internal;
    uint8_t num_children = 0;
    uint8_t slot = 0;  // place among its parent's children, for formats that leave places empty
  };
  mem::HostArray<Node> nodes;
  mem::HostArray<uint32_t> children;  // indices into nodes
  mem::HostBlock leaf_bytes;
};

inline std::span<const uint32_t> children_of(const BuildTree& tree, const BuildTree::Node& node) {
  return {tree.children.data() + node.first_child, node.num_children};
}

// Says where the nodes of a tree lie in a structure.
struct Placement {
  mem::HostArray<uint32_t> block;  // block of each node, counted from the header
  uint64_t bytes = 0;              // bytes of the structure
};

// Returns half of the area of a box.
inline double half_area(const Bounds& b) {
  const double x = double(b.high[0]) - b.low[0], y = double(b.high[1]) - b.low[1],
               z = double(b.high[2]) - b.low[2];
  return x * y + y * z + z * x;
}

}  // namespace glint::rt
