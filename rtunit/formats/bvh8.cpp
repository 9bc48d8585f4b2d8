// Node format `bvh8`, writing side: nodes packed at 80 bytes, leaves behind them.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/formats/bvh8.h"

#include "base/registry.h"
#include "rtunit/layout.h"

namespace glint::rt {
namespace {

Bvh8::Node make_node(const BuildTree& tree, const BuildTree::Node& from, const Layout& layout) {
  const std::vector<Bounds> boxes = bounds_of_children(tree, from);
  Bvh8::Node node;
  Grid grid;
  for (size_t a = 0; a < 3; ++a) quantise(boxes, a, grid, {node.low[a], node.high[a]});
  node.origin = grid.origin;
  node.exponent = grid.exponent;
  for (uint32_t index : children_of(tree, from)) {
    const NodeKind kind = tree.nodes[index].kind;
    uint32_t& first = kind == NodeKind::Internal ? node.first_node : node.first_leaf;
    if (first == 0) first = layout.block[index];
    node.kind[node.num_children++] = uint8_t(kind);
  }
  return node;
}

class Bvh8Format final : public NodeFormat {
 public:
  static constexpr std::string_view kName = "bvh8";
  static constexpr std::string_view kDoc = "80 B nodes of eight children, 8-bit planes, power-of-two steps an axis; leaves apart.";
  struct Params {
    static constexpr auto params() { return std::tuple{}; }
  };
  Bvh8Format(Params, Context) {}

  FormatId id() const override { return FormatId::Bvh8; }
  uint32_t width() const override { return Bvh8::kWidth; }
  uint32_t node_bytes() const override { return Bvh8::kNodeBytes; }

  std::vector<std::byte> encode(const BuildTree& tree) const override {
    const Layout layout = split_layout(tree, Bvh8::kNodeBytes);
    std::vector<std::byte> out = bytes_with_leaves(tree, layout);
    for (size_t n = 0; n < tree.nodes.size(); ++n) {
      if (tree.nodes[n].kind != NodeKind::Internal) continue;
      const Bvh8::Node node = make_node(tree, tree.nodes[n], layout);
      std::memcpy(&out[size_t(layout.block[n]) * kBlockBytes], &node, sizeof node);
    }
    return out;
  }

  uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) const override {
    Bvh8::Node node;
    std::memcpy(&node, bytes, sizeof node);
    const Grid grid{node.origin, node.exponent};
    const uint32_t count = node.num_children < Bvh8::kWidth ? node.num_children : uint32_t(Bvh8::kWidth);
    Bvh8::References references(node);
    for (uint32_t i = 0; i < count; ++i) {
      out[i].node = references.next(int(i));
      for (size_t a = 0; a < 3; ++a) {
        out[i].bounds.low[a] = Grid::plane(node.origin[a], node.low[a][i], grid.step(a));
        out[i].bounds.high[a] = Grid::plane(node.origin[a], node.high[a][i], grid.step(a));
      }
    }
    return count;
  }
};

const Register<NodeFormat, Bvh8Format> registered;

}  // namespace
}  // namespace glint::rt
