// Implements the node format `bvh4`: this file registers it, and bvh4.h defines its nodes.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/formats/bvh4.h"

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/registry.h"

namespace glint::rt {
namespace {

class Bvh4Format final : public NodeFormat {
 public:
  static constexpr std::string_view kName = "bvh4";
  static constexpr std::string_view kDoc =
      "Internal nodes have 128 B and four children, whose planes are in single precision.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Bvh4Format(Params, Context) {}

  FormatId id() const override { return FormatId::Bvh4; }
  uint32_t width() const override { return Bvh4::kWidth; }
  uint32_t node_bytes() const override { return Bvh4::kNodeBytes; }
  Placement place(const BuildTree& tree, const NodeOrder& order) const override {
    return mixed_placement(tree, order, Bvh4::kNodeBytes);
  }
  mem::HostBlock encode(const BuildTree& tree, const Placement& placement, uint32_t threads) const override {
    return Bvh4::encode(tree, placement, threads);
  }
  uint32_t decode(const std::byte* node, std::span<DecodedChild> out) const override {
    return Bvh4::decode(node, out);
  }
};

const Register<NodeFormat, Bvh4Format> registered;

}  // namespace
}  // namespace glint::rt
