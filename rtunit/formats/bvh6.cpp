// Node format `bvh6`, writing side.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/formats/bvh6.h"

#include "base/registry.h"
#include "rtunit/layout.h"

namespace glint::rt {
namespace {

Bvh6::Node make_node(const BuildTree& tree, const BuildTree::Node& from, const Layout& layout) {
  const std::vector<Bounds> boxes = bounds_of_children(tree, from);
  Bvh6::Node node;
  Grid grid;
  for (size_t a = 0; a < 3; ++a) quantise(boxes, a, grid, {node.low[a], node.high[a]});
  node.origin = grid.origin;
  node.exponent = grid.exponent;
  for (uint32_t index : children_of(tree, from)) {
    if (node.num_children == 0) node.first_block = layout.block[index];
    node.kind[node.num_children++] = uint8_t(tree.nodes[index].kind);
  }
  return node;
}

class Bvh6Format final : public NodeFormat {
 public:
  static constexpr std::string_view kName = "bvh6";
  static constexpr std::string_view kDoc = "64 B nodes of six children, 8-bit planes, power-of-two steps an axis.";
  struct Params {
    static constexpr auto params() { return std::tuple{}; }
  };
  Bvh6Format(Params, Context) {}

  FormatId id() const override { return FormatId::Bvh6; }
  uint32_t width() const override { return Bvh6::kWidth; }
  uint32_t node_bytes() const override { return Bvh6::kNodeBytes; }

  std::vector<std::byte> encode(const BuildTree& tree) const override {
    const Layout layout = mixed_layout(tree, Bvh6::kNodeBytes);
    std::vector<std::byte> out = bytes_with_leaves(tree, layout);
    for (size_t n = 0; n < tree.nodes.size(); ++n) {
      if (tree.nodes[n].kind != NodeKind::Internal) continue;
      const Bvh6::Node node = make_node(tree, tree.nodes[n], layout);
      std::memcpy(&out[size_t(layout.block[n]) * kBlockBytes], &node, sizeof node);
    }
    return out;
  }

  uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) const override {
    Bvh6::Node node;
    std::memcpy(&node, bytes, sizeof node);
    const Grid grid{node.origin, node.exponent};
    uint32_t block = node.first_block;
    const uint32_t count = node.num_children < Bvh6::kWidth ? node.num_children : uint32_t(Bvh6::kWidth);
    for (uint32_t i = 0; i < count; ++i) {
      const NodeKind kind = NodeKind(node.kind[i] & 7);
      out[i].node = node_ref(block, kind);
      for (size_t a = 0; a < 3; ++a) {
        out[i].bounds.low[a] = Grid::plane(node.origin[a], node.low[a][i], grid.step(a));
        out[i].bounds.high[a] = Grid::plane(node.origin[a], node.high[a][i], grid.step(a));
      }
      block += Bvh6::blocks_of(kind);
    }
    return count;
  }
};

const Register<NodeFormat, Bvh6Format> registered;

}  // namespace
}  // namespace glint::rt
