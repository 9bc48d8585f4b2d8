// Implements the node format `bvh6`: 64-byte nodes of six boxes in 8 bits per plane, as Intel's hardware and
// the published simulators have it.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "rtunit/formats/quantised_boxes.h"

namespace glint::rt {
namespace {

class Bvh6 final : public QuantisedBoxes<Bvh6> {
 public:
  static constexpr std::string_view kName = "bvh6";
  static constexpr std::string_view kDoc =
      "Internal nodes have 64 B and six children, whose planes have 8 bits and one power-of-two step per "
      "axis.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Bvh6(Params, Context) {}

  Placement place(const BuildTree& tree, const NodeOrder& order) const override {
    return mixed_placement(tree, order, kNodeBytes);
  }
  mem::HostBlock encode(const BuildTree& tree, const Placement& placement, uint32_t threads) const override {
    return encode_linked(tree, placement, threads, [&](Node& node, std::span<const uint32_t> children) {
      if (!children.empty()) node.first_block = placement.block[children[0]];
    });
  }

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

  // Internal nodes are as large as leaves that are no instances, and siblings follow each other without gaps.
  class References {
   public:
    explicit References(const std::byte* node)
        : first_block_(load<uint32_t>(node + offsetof(Node, first_block))),
          kinds_(kinds(node)),
          blocks_(word_bytes::sums_below(kNodeBytes / kBlockBytes * word_bytes::kOnes +
                                         (leaf_bytes(NodeKind::Instance) - kNodeBytes) / kBlockBytes *
                                             word_bytes::equal(kinds_, uint64_t(NodeKind::Instance)))) {}
    NodeRef operator[](int child) const {
      return node_ref(first_block_ + word_bytes::get(blocks_, child),
                      NodeKind(word_bytes::get(kinds_, child)));
    }

   private:
    static_assert(kNodeBytes == kLeafBytes);
    const uint32_t first_block_;
    const uint64_t kinds_, blocks_;  // a byte for each child; blocks_ counts from first_block_
  };
};

const Register<NodeFormat, Bvh6> registered;

}  // namespace
}  // namespace glint::rt
