// Finds the shape of a tree over boxes with Embree's builder, which uses the surface-area heuristic.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rtunit/node_format.h"

namespace glint::rt {

// Describes a leaf to be put into the tree. It has the bytes of the builder's primitives, so that leaves are
// not held twice.
struct alignas(32) BuildItem {
  std::array<float, 3> low{};
  uint32_t zero = 0;
  std::array<float, 3> high{};
  NodeRef leaf = 0;  // its kind, and the blocks from the start of BuildTree::leaf_bytes

  BuildItem() = default;
  BuildItem(const Bounds& bounds, NodeKind kind, uint32_t leaf_block)
      : low(bounds.low), high(bounds.high), leaf(node_ref(leaf_block, kind)) {}
  Bounds bounds() const { return {low, high}; }
};

// Fills tree.nodes and tree.children on up to `threads` threads. Nodes come depth first: the children of a
// node follow each other, and what is below the first comes next. Each item becomes a leaf, each node has at
// most `width` children, and the root is internal. The same items give the same tree at any number of
// threads. The order of `items` changes.
void build_tree(std::span<BuildItem> items, uint32_t width, uint32_t threads, BuildTree& tree);

// Does the same without a look at areas: each node's leaves are halved by number, along the longest side of
// the box of their middles, so that the tree is as flat as it can be.
void build_balanced_tree(std::span<BuildItem> items, uint32_t width, BuildTree& tree);

Bounds empty_bounds();
inline void extend(Bounds& bounds, const Bounds& other) {
  for (size_t a = 0; a < 3; ++a) {
    bounds.low[a] = bounds.low[a] < other.low[a] ? bounds.low[a] : other.low[a];
    bounds.high[a] = bounds.high[a] > other.high[a] ? bounds.high[a] : other.high[a];
  }
}

}  // namespace glint::rt
