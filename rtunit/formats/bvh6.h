// Defines the node format `bvh6`: 64-byte nodes of six boxes in 8 bits per plane, as Intel's hardware and the
// published simulators have it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "rtunit/formats/quantised_boxes.h"

namespace glint::rt {

struct Bvh6 : QuantisedBoxes<Bvh6> {
  static constexpr int kWidth = 6;

  struct Node {
    std::array<float, 3> origin{};
    uint32_t first_block = 0;  // block of child 0; the others follow without gaps
    std::array<uint8_t, 3> exponent{};
    uint8_t num_children = 0;
    uint8_t low[3][kWidth]{}, high[3][kWidth]{};
    std::array<uint8_t, kWidth> kind{};
    uint8_t pad[2]{};
  };
  static constexpr uint32_t kNodeBytes = sizeof(Node);
  static_assert(kNodeBytes == 64);

  // Returns the references of a node's children, one after the other. Internal nodes are as large as leaves,
  // and siblings follow each other without gaps.
  class References {
   public:
    explicit References(const Node& node) : node_(node), block_(node.first_block) {}
    NodeRef next(int child) {
      const NodeKind kind = NodeKind(node_.kind[size_t(child)] & 7);
      const NodeRef out = node_ref(block_, kind);
      block_ += (kind == NodeKind::Internal ? kNodeBytes : leaf_bytes(kind)) / kBlockBytes;
      return out;
    }

   private:
    const Node& node_;
    uint32_t block_;
  };
};

}  // namespace glint::rt
