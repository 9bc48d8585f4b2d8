// Defines the node format `bvh8`: 80-byte nodes of eight boxes in 8 bits per plane (Ylitie, Karras, Laine
// 2017).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "rtunit/formats/quantised_boxes.h"

namespace glint::rt {

// Figure 2 of "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs" gives the layout: 12
// B for the origin, 3 B for exponents, 1 B, two base indices of 4 B, 8 B about the children and 48 B for
// planes. Nodes and leaves lie in arrays of their own. Model: children are visited by distance, as in every
// format, and not in the paper's order by octant. So the byte behind the exponents counts the children, and
// the kinds say which are nodes.
struct Bvh8 : QuantisedBoxes<Bvh8> {
  static constexpr int kWidth = 8;

  struct Node {
    std::array<float, 3> origin{};
    std::array<uint8_t, 3> exponent{};
    uint8_t num_children = 0;
    uint32_t first_node = 0, first_leaf = 0;  // blocks of the first internal child and the first leaf
    std::array<uint8_t, kWidth> kind{};
    uint8_t low[3][kWidth]{}, high[3][kWidth]{};
  };
  static constexpr uint32_t kNodeBytes = sizeof(Node);
  static_assert(kNodeBytes == 80 && kNodeBytes % kBlockBytes == 0);

  // Returns the references of a node's children, one after the other.
  class References {
   public:
    explicit References(const Node& node)
        : node_(node), next_node_(node.first_node), next_leaf_(node.first_leaf) {}
    NodeRef next(int child) {
      const NodeKind kind = NodeKind(node_.kind[size_t(child)] & 7);
      uint32_t& next = kind == NodeKind::Internal ? next_node_ : next_leaf_;
      const NodeRef out = node_ref(next, kind);
      next += (kind == NodeKind::Internal ? kNodeBytes : leaf_bytes(kind)) / kBlockBytes;
      return out;
    }

   private:
    const Node& node_;
    uint32_t next_node_, next_leaf_;
  };
};

}  // namespace glint::rt
