// Implements the node format `bvh6`: this file registers it and writes its nodes.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/formats/bvh6.h"

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/registry.h"

namespace glint::rt {
namespace {

class Bvh6Format final : public NodeFormat {
 public:
  static constexpr std::string_view kName = "bvh6";
  static constexpr std::string_view kDoc =
      "Internal nodes have 64 B and six children, whose planes have 8 bits and one power-of-two step per "
      "axis.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Bvh6Format(Params, Context) {}

  FormatId id() const override { return FormatId::Bvh6; }
  uint32_t width() const override { return Bvh6::kWidth; }
  uint32_t node_bytes() const override { return Bvh6::kNodeBytes; }

  Placement place(const BuildTree& tree, const NodeOrder& order) const override {
    return mixed_placement(tree, order, Bvh6::kNodeBytes);
  }
  mem::HostBlock encode(const BuildTree& tree, const Placement& placement, uint32_t threads) const override {
    return Bvh6::encode(tree, placement, threads, [&](Bvh6::Node& node, std::span<const uint32_t> children) {
      if (!children.empty()) node.first_block = placement.block[children[0]];
    });
  }
  uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) const override {
    return Bvh6::decode(bytes, out);
  }
};

const Register<NodeFormat, Bvh6Format> registered;

}  // namespace
}  // namespace glint::rt
