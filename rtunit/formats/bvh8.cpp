// Implements the node format `bvh8`: 80-byte nodes of eight boxes in 8 bits per plane (Ylitie, Karras, Laine
// 2017).
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "rtunit/formats/quantised_boxes.h"

namespace glint::rt {
namespace {

// Figure 2 of "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs" gives the layout: 12
// B for the origin, 3 B for exponents, 1 B, two base indices of 4 B, 8 B about the children and 48 B for
// planes. Nodes and leaves lie in arrays of their own. Choice: children lie as the builder gives them and not
// in the paper's slots by octant, which `cwbvh` has. So the byte behind the exponents counts the children,
// and the kinds say which are nodes.
class Bvh8 final : public QuantisedBoxes<Bvh8> {
 public:
  static constexpr std::string_view kName = "bvh8";
  static constexpr std::string_view kDoc =
      "Internal nodes have 80 B and eight children, whose planes have 8 bits and one power-of-two step per "
      "axis. Leaves lie apart from them.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Bvh8(Params, Context) {}

  Placement place(const BuildTree& tree, const NodeOrder& order) const override {
    return split_placement(tree, order, kNodeBytes);
  }
  mem::HostBlock encode(const BuildTree& tree, const Placement& placement, uint32_t threads) const override {
    return encode_linked(tree, placement, threads, [&](Node& node, std::span<const uint32_t> children) {
      for (const uint32_t index : children) {
        uint32_t& first = tree.nodes[index].kind == NodeKind::Internal ? node.first_node : node.first_leaf;
        if (first == 0) first = placement.block[index];
      }
    });
  }

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

  // Children of each sort, nodes and leaves, follow each other without gaps.
  class References {
   public:
    explicit References(const std::byte* node)
        : first_node_(load<uint32_t>(node + offsetof(Node, first_node))),
          first_leaf_(load<uint32_t>(node + offsetof(Node, first_leaf))),
          kinds_(kinds(node)) {
      const uint64_t inner = word_bytes::equal(kinds_, uint64_t(NodeKind::Internal)),
                     instances = word_bytes::equal(kinds_, uint64_t(NodeKind::Instance));
      node_blocks_ = word_bytes::sums_below(kNodeBytes / kBlockBytes * inner);
      leaf_blocks_ =
          word_bytes::sums_below(kLeafBytes / kBlockBytes * (word_bytes::kOnes - inner) +
                                 (leaf_bytes(NodeKind::Instance) - kLeafBytes) / kBlockBytes * instances);
    }
    NodeRef operator[](int child) const {
      const auto kind = NodeKind(word_bytes::get(kinds_, child));
      const uint32_t block = kind == NodeKind::Internal ? first_node_ + word_bytes::get(node_blocks_, child)
                                                        : first_leaf_ + word_bytes::get(leaf_blocks_, child);
      return node_ref(block, kind);
    }

   private:
    const uint32_t first_node_, first_leaf_;
    const uint64_t kinds_;
    uint64_t node_blocks_, leaf_blocks_;  // a byte for each child, counted from the first node and leaf
  };
};

const Register<NodeFormat, Bvh8> registered;

}  // namespace
}  // namespace glint::rt
