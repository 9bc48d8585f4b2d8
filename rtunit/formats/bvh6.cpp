// Node format `bvh6`, writing side: depth-first packing and outward quantisation.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/formats/bvh6.h"

#include <cmath>

#include "base/check.h"
#include "base/registry.h"
#include "rtunit/node_format.h"

namespace glint::rt {
namespace {

using Node = Bvh6::Node;
using Children = std::span<const uint32_t>;

// Quantises one axis with the given exponent; false when a plane does not fit in 8 bits.
bool quantise(const BuildTree& tree, Children children, int axis, uint8_t exponent, Node& node) {
  const float origin = node.origin[axis], scale = Bvh6::scale(exponent);
  for (size_t i = 0; i < children.size(); ++i) {
    const Bounds& box = tree.nodes[children[i]].bounds;
    const double low = std::floor((double(box.low[axis]) - origin) / scale);
    const double high = std::ceil((double(box.high[axis]) - origin) / scale);
    if (high > 255) return false;
    int q_low = int(low), q_high = int(high);
    // the decoded plane is rounded to float: step outwards until it is not inside the box
    while (q_low > 0 && Bvh6::plane(origin, uint8_t(q_low), scale) > box.low[axis]) --q_low;
    while (q_high <= 255 && Bvh6::plane(origin, uint8_t(q_high), scale) < box.high[axis]) ++q_high;
    if (q_high > 255) return false;
    node.low[axis][i] = uint8_t(q_low);
    node.high[axis][i] = uint8_t(q_high);
  }
  node.exponent[axis] = exponent;
  return true;
}

void quantise_all(const BuildTree& tree, Children children, Node& node) {
  for (int a = 0; a < 3; ++a) {
    float low = 0, high = 0;
    for (size_t i = 0; i < children.size(); ++i) {
      const Bounds& box = tree.nodes[children[i]].bounds;
      low = i ? std::fmin(low, box.low[a]) : box.low[a];
      high = i ? std::fmax(high, box.high[a]) : box.high[a];
    }
    node.origin[a] = low;
    // smallest power of two with 255 steps over the extent
    const double step = (double(high) - low) / 255;
    int exponent = step > 0 ? std::ilogb(step) + 127 : 1;
    exponent = exponent < 1 ? 1 : exponent;
    while (!quantise(tree, children, a, uint8_t(exponent), node)) {
      ++exponent;
      GLINT_CHECK(exponent <= 254, "a box of {} to {} does not fit the node format", low, high);
    }
  }
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

  std::vector<std::byte> encode(const BuildTree& tree) const override {
    std::vector<std::byte> out((kRootBlock + 1) * kBlockBytes);
    struct Work {
      uint32_t node, block;
    };
    std::vector<Work> stack{{0, kRootBlock}};
    while (!stack.empty()) {
      const Work work = stack.back();
      stack.pop_back();
      const BuildTree::Node& from = tree.nodes[work.node];
      const Children children{tree.children.data() + from.first_child, from.num_children};
      Node node;
      node.num_children = uint8_t(children.size());
      node.first_block = uint32_t(out.size() / kBlockBytes);
      quantise_all(tree, children, node);
      std::vector<Work> inner;
      for (size_t i = 0; i < children.size(); ++i) {
        const BuildTree::Node& child = tree.nodes[children[i]];
        node.kind[i] = uint8_t(child.kind);
        const size_t offset = out.size(), bytes = size_t(blocks_of(child.kind)) * kBlockBytes;
        out.resize(offset + bytes);
        if (child.kind == NodeKind::Internal)
          inner.push_back({children[i], uint32_t(offset / kBlockBytes)});
        else
          std::memcpy(&out[offset], &tree.leaf_bytes[size_t(child.leaf_block) * kBlockBytes], bytes);
      }
      std::memcpy(&out[size_t(work.block) * kBlockBytes], &node, sizeof node);
      stack.insert(stack.end(), inner.rbegin(), inner.rend());  // first child's subtree next
    }
    return out;
  }

  uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) const override {
    Node node;
    std::memcpy(&node, bytes, sizeof node);
    uint32_t block = node.first_block;
    const uint32_t count = node.num_children < Bvh6::kWidth ? node.num_children : uint32_t(Bvh6::kWidth);
    for (uint32_t i = 0; i < count; ++i) {
      const NodeKind kind = NodeKind(node.kind[i] & 7);
      out[i].node = node_ref(block, kind);
      for (int a = 0; a < 3; ++a) {
        const float s = Bvh6::scale(node.exponent[a]);
        out[i].bounds.low[a] = Bvh6::plane(node.origin[a], node.low[a][i], s);
        out[i].bounds.high[a] = Bvh6::plane(node.origin[a], node.high[a][i], s);
      }
      block += blocks_of(kind);
    }
    return count;
  }
};

const Register<NodeFormat, Bvh6Format> registered;

}  // namespace
}  // namespace glint::rt
