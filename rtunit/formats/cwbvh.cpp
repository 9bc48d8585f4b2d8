// Implements the node format `cwbvh`: the 80-byte nodes of Ylitie, Karras and Laine 2017, whose children lie
// in the order in which rays visit them.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "base/parallel_ranges.h"
#include "base/registry.h"
#include "rtunit/formats/octant_slots.h"
#include "rtunit/formats/quantised_boxes.h"

namespace glint::rt {
namespace {

// Figure 2 of "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs" gives the layout. A
// byte `meta` of a child that is a node holds 001 and 24 + its slot, and `inner_slots` says which children
// are nodes: the n-th of them is the n-th node behind first_node. Empty slots have meta 0. Model: A leaf is
// one record of 64 B with up to two triangles, or the 128 B of an instance, where the paper has up to three
// triangles in a row. So the upper 3 bits of a leaf's meta hold its kind and not a count in unary, and the
// lower 5 bits count records of 64 B. Model: A ray's stack has an entry for each child. The paper's holds a
// node's children that are left in one entry of 8 B.
class Cwbvh final : public QuantisedBoxes<Cwbvh> {
 public:
  static constexpr std::string_view kName = "cwbvh";
  static constexpr std::string_view kDoc =
      "Internal nodes have 80 B and eight children, as those of bvh8. The children lie in slots by octant, "
      "which rt.child_order = \"octant\" goes by.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Cwbvh(Params, Context) {}

  static constexpr int kWidth = int(kSlots);
  struct Node {
    std::array<float, 3> origin{};
    std::array<uint8_t, 3> exponent{};
    uint8_t inner_slots = 0;
    uint32_t first_node = 0, first_leaf = 0;  // blocks
    std::array<uint8_t, kWidth> meta{};
    uint8_t low[3][kWidth]{}, high[3][kWidth]{};
  };
  static constexpr uint32_t kNodeBytes = sizeof(Node);
  static_assert(kNodeBytes == 80);

  bool has_octant_slots() const override { return true; }
  void arrange(BuildTree& tree, uint32_t threads) const override {
    constexpr size_t kRange = 4096;  // nodes that a thread takes at a time
    const size_t count = tree.nodes.size();
    parallel_ranges(count, kRange, threads, [&](size_t begin, size_t end) {
      for (size_t n = begin; n < end; ++n) give_slots(tree, tree.nodes[n]);
    });
    // A node's children have higher numbers than it has, so no family is taken apart by one that comes later.
    for (size_t n = 0; n < count; ++n) sort_by_slot(tree, tree.nodes[n]);
  }

  Placement place(const BuildTree& tree, const NodeOrder& order) const override {
    return split_placement(tree, order, kNodeBytes);
  }

  mem::HostBlock encode(const BuildTree& tree, const Placement& placement, uint32_t threads) const override {
    return encoded(tree, placement, threads, [&](const BuildTree::Node& from) {
      const auto children = children_of(tree, from);
      std::array<Bounds, kSlots> bounds;
      for (size_t i = 0; i < children.size(); ++i) bounds[i] = tree.nodes[children[i]].bounds;
      Node node;
      Grid grid;
      for (size_t a = 0; a < 3; ++a) {
        std::array<uint8_t, kSlots> low{}, high{};
        quantise<kMostInByte, uint8_t>({bounds.data(), children.size()}, a, grid, {low, high});
        for (size_t i = 0; i < children.size(); ++i) {
          const uint8_t slot = tree.nodes[children[i]].slot;
          node.low[a][slot] = low[i], node.high[a][slot] = high[i];
        }
      }
      node.origin = grid.origin, node.exponent = grid.exponent;
      for (const uint32_t index : children) link(node, tree.nodes[index], placement.block[index]);
      return node;
    });
  }

  static Present present(const std::byte* node) {
    const auto meta = load<uint64_t>(node + offsetof(Node, meta));
    uint32_t mask = 0;
    for (int i = 0; i < kWidth; ++i) mask |= uint32_t(word_bytes::get(meta, i) != 0) << i;
    return {mask, uint32_t(std::popcount(mask))};
  }

  class References {
   public:
    explicit References(const std::byte* node)
        : first_node_(load<uint32_t>(node + offsetof(Node, first_node))),
          first_leaf_(load<uint32_t>(node + offsetof(Node, first_leaf))),
          inner_slots_(uint8_t(node[offsetof(Node, inner_slots)])),
          meta_(load<uint64_t>(node + offsetof(Node, meta))) {}
    NodeRef operator[](int child) const {
      if (inner_slots_ >> child & 1) {
        const auto before = uint32_t(std::popcount(inner_slots_ & ((1u << child) - 1)));
        return node_ref(first_node_ + before * (kNodeBytes / kBlockBytes), NodeKind::Internal);
      }
      const uint32_t meta = word_bytes::get(meta_, child);
      return node_ref(first_leaf_ + (meta & kRecordMask) * (kLeafBytes / kBlockBytes),
                      NodeKind(meta >> kKindShift));
    }

   private:
    const uint32_t first_node_, first_leaf_, inner_slots_;
    const uint64_t meta_;
  };

 private:
  static constexpr uint32_t kKindShift = 5, kRecordMask = 31, kInner = 0x20 + 24;
  // A leaf's meta is never 0, since the kind 0 is that of internal nodes.
  static_assert(uint32_t(NodeKind::Internal) == 0 && uint32_t(NodeKind::TriangleSecond) < 8);

  static void give_slots(BuildTree& tree, const BuildTree::Node& parent) {
    if (parent.kind != NodeKind::Internal || parent.num_children == 0) return;
    std::array<Bounds, kSlots> bounds;
    const auto children = children_of(tree, parent);
    for (size_t i = 0; i < children.size(); ++i) bounds[i] = tree.nodes[children[i]].bounds;
    const auto slots = octant_slots({bounds.data(), children.size()});
    for (size_t i = 0; i < children.size(); ++i) tree.nodes[children[i]].slot = slots[i];
  }

  // The numbers of the siblings stay those that they were, and the siblings are dealt out to them anew.
  static void sort_by_slot(BuildTree& tree, const BuildTree::Node& parent) {
    if (parent.kind != NodeKind::Internal) return;
    const auto children = children_of(tree, parent);
    for (size_t i = 1; i < children.size(); ++i)
      for (size_t at = i; at > 0 && tree.nodes[children[at]].slot < tree.nodes[children[at - 1]].slot; --at)
        std::swap(tree.nodes[children[at]], tree.nodes[children[at - 1]]);
  }

  static void link(Node& node, const BuildTree::Node& child, uint32_t block) {
    if (child.kind == NodeKind::Internal) {
      if (!node.inner_slots) node.first_node = block;
      node.inner_slots = uint8_t(node.inner_slots | 1u << child.slot);
      node.meta[child.slot] = uint8_t(kInner + child.slot);
    } else {
      if (!node.first_leaf) node.first_leaf = block;
      const uint32_t record = (block - node.first_leaf) / (kLeafBytes / kBlockBytes);
      node.meta[child.slot] = uint8_t(uint32_t(child.kind) << kKindShift | record);
    }
  }
};

const Register<NodeFormat, Cwbvh> registered;

}  // namespace
}  // namespace glint::rt
