// Implements the node format `bvh2`: this file registers it, and bvh2.h defines its nodes.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/formats/bvh2.h"

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/registry.h"

namespace glint::rt {
namespace {

class Bvh2Format final : public NodeFormat {
 public:
  static constexpr std::string_view kName = "bvh2";
  static constexpr std::string_view kDoc =
      "Internal nodes have 64 B and two children, whose planes are in single precision.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Bvh2Format(Params, Context) {}

  FormatId id() const override { return FormatId::Bvh2; }
  uint32_t width() const override { return Bvh2::kWidth; }
  uint32_t node_bytes() const override { return Bvh2::kNodeBytes; }
  Placement place(const BuildTree& tree, const NodeOrder& order) const override {
    return mixed_placement(tree, order, Bvh2::kNodeBytes);
  }
  mem::HostBlock encode(const BuildTree& tree, const Placement& placement, uint32_t threads) const override {
    return Bvh2::encode(tree, placement, threads);
  }
  uint32_t decode(const std::byte* node, std::span<DecodedChild> out) const override {
    return Bvh2::decode(node, out);
  }
};

const Register<NodeFormat, Bvh2Format> registered;

}  // namespace
}  // namespace glint::rt
