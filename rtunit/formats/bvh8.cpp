// Implements the node format `bvh8`: this file registers it and writes its nodes, packed at 80 bytes, with
// the leaves behind them.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/formats/bvh8.h"

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/registry.h"

namespace glint::rt {
namespace {

class Bvh8Format final : public NodeFormat {
 public:
  static constexpr std::string_view kName = "bvh8";
  static constexpr std::string_view kDoc =
      "Internal nodes have 80 B and eight children, whose planes have 8 bits and one power-of-two step per "
      "axis. Leaves lie apart from them.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Bvh8Format(Params, Context) {}

  FormatId id() const override { return FormatId::Bvh8; }
  uint32_t width() const override { return Bvh8::kWidth; }
  uint32_t node_bytes() const override { return Bvh8::kNodeBytes; }

  Placement place(const BuildTree& tree, const NodeOrder& order) const override {
    return split_placement(tree, order, Bvh8::kNodeBytes);
  }
  mem::HostBlock encode(const BuildTree& tree, const Placement& placement, uint32_t threads) const override {
    return Bvh8::encode(tree, placement, threads, [&](Bvh8::Node& node, std::span<const uint32_t> children) {
      for (const uint32_t index : children) {
        uint32_t& first = tree.nodes[index].kind == NodeKind::Internal ? node.first_node : node.first_leaf;
        if (first == 0) first = placement.block[index];
      }
    });
  }
  uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) const override {
    return Bvh8::decode(bytes, out);
  }
};

const Register<NodeFormat, Bvh8Format> registered;

}  // namespace
}  // namespace glint::rt
