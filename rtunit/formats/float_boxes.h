// Defines nodes with boxes in single precision and one reference for each child, which the formats without
// quantisation share.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "rtunit/intersection/box_test.h"
#include "rtunit/intersection/ray_space.h"
#include "rtunit/structure/layout.h"

namespace glint::rt {

template <int kChildren>
struct FloatBoxes {
  static constexpr int kWidth = kChildren;
  static constexpr NodeRef kNone = 0;  // Block 0 is the header, so no child has this reference.

  struct Node {
    float low[3][kWidth]{}, high[3][kWidth]{};
    NodeRef child[kWidth]{};  // The children that exist come first.
    uint32_t pad[kWidth == 2 ? 2 : 4]{};
  };
  static constexpr uint32_t kNodeBytes = sizeof(Node);

  // Writes the children that the ray enters in [t_min, t_max], in index order. Returns their number and
  // counts the tests.
  static int test(const std::byte* bytes, const RaySpace& space, float t_min, float t_max, float* t_enter,
                  NodeRef* child, uint32_t& box_tests) {
    Node node;
    std::memcpy(&node, bytes, sizeof node);
    float t_near[kWidth], t_far[kWidth];
    for (int i = 0; i < kWidth; ++i) t_near[i] = -__builtin_inff(), t_far[i] = __builtin_inff();
    for (int a = 0; a < 3; ++a) {
      const bool backward = std::signbit(space.inverse_direction[a]);
      const float* near_plane = backward ? node.high[a] : node.low[a];
      const float* far_plane = backward ? node.low[a] : node.high[a];
      for (int i = 0; i < kWidth; ++i)
        clip_slab(near_plane[i], far_plane[i], space.origin[a], space.inverse_direction[a], t_near[i],
                  t_far[i]);
    }
    for (int i = 0; i < kWidth; ++i) clip_to_ray(t_min, t_max, t_near[i], t_far[i]);
    int hits = 0;
    // A child is written in any case, and kept if it is entered: a branch could not be foreseen.
    for (int i = 0; i < kWidth && node.child[i] != kNone; ++i) {
      ++box_tests;
      t_enter[hits] = t_near[i];
      child[hits] = node.child[i];
      hits += t_near[i] <= t_far[i];
    }
    return hits;
  }

  static std::vector<std::byte> encode(const BuildTree& tree) {
    const Layout layout = mixed_layout(tree, kNodeBytes);
    std::vector<std::byte> out = bytes_with_leaves(tree, layout);
    for (size_t n = 0; n < tree.nodes.size(); ++n) {
      if (tree.nodes[n].kind != NodeKind::Internal) continue;
      Node node;
      int i = 0;
      for (uint32_t index : children_of(tree, tree.nodes[n])) {
        const BuildTree::Node& child = tree.nodes[index];
        node.child[i] = node_ref(layout.block[index], child.kind);
        for (size_t a = 0; a < 3; ++a)
          node.low[a][i] = child.bounds.low[a], node.high[a][i] = child.bounds.high[a];
        ++i;
      }
      std::memcpy(&out[size_t(layout.block[n]) * kBlockBytes], &node, sizeof node);
    }
    return out;
  }

  static uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) {
    Node node;
    std::memcpy(&node, bytes, sizeof node);
    uint32_t count = 0;
    for (; count < kWidth && node.child[count] != kNone; ++count) {
      out[count].node = node.child[count];
      for (size_t a = 0; a < 3; ++a) {
        out[count].bounds.low[a] = node.low[a][count];
        out[count].bounds.high[a] = node.high[a][count];
      }
    }
    return count;
  }
};

}  // namespace glint::rt
