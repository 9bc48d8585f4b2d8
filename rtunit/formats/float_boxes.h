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
#include "rtunit/structure/placement.h"
#include "rtunit/traversal/format_of.h"

namespace glint::rt {

// A format derives from FloatBoxes<itself, number of children>.
template <class Format, int kChildren>
class FloatBoxes : public FormatOf<Format> {
 public:
  static constexpr int kWidth = kChildren;
  static constexpr NodeRef kNone = 0;  // Block 0 is the header, so no child has this reference.

  struct Node {
    float low[3][kWidth]{}, high[3][kWidth]{};
    NodeRef child[kWidth]{};  // The children that exist come first.
    uint32_t pad[kWidth == 2 ? 2 : 4]{};
  };
  static constexpr uint32_t kNodeBytes = sizeof(Node);

  static constexpr int kPlanes = 4;

  class References {
   public:
    explicit References(const std::byte* node) : node_(node + offsetof(Node, child)) {}
    NodeRef operator[](int child) const { return load<NodeRef>(node_ + size_t(child) * sizeof(NodeRef)); }

   private:
    const std::byte* node_;
  };

  // Planes of missing children are whatever follows in the node, and nobody looks at what they give.
  static uint32_t test(const std::byte* bytes, const RaySpace& space, float t_min, float t_max,
                       float* t_enter, uint32_t& box_tests) {
    Four t_near = all<Four>(-__builtin_inff()), t_far = all<Four>(__builtin_inff());
    for (size_t a = 0; a < 3; ++a) {
      const bool backward = std::signbit(space.inverse_direction[a]);
      const auto *low = bytes + offsetof(Node, low) + a * sizeof(float) * kWidth,
                 *high = low + sizeof(Node::low);
      clip_slab(load<Four>(backward ? high : low), load<Four>(backward ? low : high), space.origin[a],
                space.inverse_direction[a], t_near, t_far);
    }
    clip_to_ray(t_min, t_max, t_near, t_far);
    std::memcpy(t_enter, &t_near, sizeof t_near);
    const References child(bytes);
    int count = 0;
    while (count < kWidth && child[count] != kNone) ++count;
    box_tests += uint32_t(count);
    return mask_of(t_near <= t_far) & ((1u << count) - 1);
  }

  Placement place(const BuildTree& tree, const NodeOrder& order) const override {
    return mixed_placement(tree, order, kNodeBytes);
  }

  mem::HostBlock encode(const BuildTree& tree, const Placement& placement, uint32_t threads) const override {
    return encoded(tree, placement, threads, [&](const BuildTree::Node& from) {
      Node node;
      int i = 0;
      for (uint32_t index : children_of(tree, from)) {
        const BuildTree::Node& child = tree.nodes[index];
        node.child[i] = node_ref(placement.block[index], child.kind);
        for (size_t a = 0; a < 3; ++a)
          node.low[a][i] = child.bounds.low[a], node.high[a][i] = child.bounds.high[a];
        ++i;
      }
      return node;
    });
  }

  uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) const override {
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
