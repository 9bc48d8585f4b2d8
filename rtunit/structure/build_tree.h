// Finds the shape of a tree over boxes with Embree's builder, which uses the surface-area heuristic.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "rtunit/node_format.h"

namespace glint::rt {

// Describes a leaf to be put into the tree: `leaf_block` and `kind` go into its BuildTree::Node.
struct BuildItem {
  Bounds bounds;
  NodeKind kind = NodeKind::Triangle;
  uint32_t leaf_block = 0;
};

// Fills tree.nodes and tree.children, parents before children. Each item becomes a leaf, each node has at
// most `width` children, and the root is internal. The same items give the same tree.
void build_tree(std::span<const BuildItem> items, uint32_t width, BuildTree& tree);

Bounds empty_bounds();
void extend(Bounds& bounds, const Bounds& other);

}  // namespace glint::rt
