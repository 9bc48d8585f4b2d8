// Implements the node format `bvh8_12bit`: 128-byte nodes of eight boxes in 12 bits per plane, as large as
// the box nodes of AMD's RDNA 4.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "base/registry.h"
#include "rtunit/formats/quantise.h"
#include "rtunit/intersection/box_test.h"
#include "rtunit/intersection/ray_space.h"
#include "rtunit/structure/placement.h"
#include "rtunit/traversal/format_of.h"

namespace glint::rt {
namespace {

// Mesa's driver for these GPUs says what a node holds (src/amd/vulkan/bvh/bvh.h, radv_gfx12_box_node): 32 B
// with the numbers of the first child of each sort and of the parent, the origin, three exponents with the
// number of children less one, and the number of a rotation of the boxes; then 12 B for each child with six
// planes of 12 bits, 8 bits of flags, 8 of the instance mask, and 4 each for kind and size. An upper plane q
// lies at q + 1 steps. Model: The parent, the rotation, the flags and the mask are not used. A leaf has 64 B,
// where the GPU has 128 B of compressed triangles, so sizes count 64 B. Choice: an exponent is
// that of a step and not that of 4096 steps, so that boxes of every size fit.
class Bvh8In12Bits final : public FormatOf<Bvh8In12Bits> {
 public:
  static constexpr std::string_view kName = "bvh8_12bit";
  static constexpr std::string_view kDoc =
      "Internal nodes have 128 B and eight children, whose planes have 12 bits and one power-of-two step per "
      "axis. Leaves lie apart from them.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Bvh8In12Bits(Params, Context) {}

  static constexpr int kWidth = 8, kPlanes = 8;
  struct Node {
    uint32_t first_node = 0, first_leaf = 0;  // blocks of the first internal child and the first leaf
    uint32_t parent = 0;
    std::array<float, 3> origin{};
    uint32_t exponents_and_count = 0;  // 8 bits for each axis; upper 4: children - 1, modulo 16
    uint32_t rotation = 0;
    std::array<std::array<uint32_t, 3>, kWidth> child{};
  };
  static constexpr uint32_t kNodeBytes = sizeof(Node);
  static_assert(kNodeBytes == 128);

  // Nodes but the root, which lies right behind the header, lie at multiples of their size, as the GPU asks.
  Placement place(const BuildTree& tree, const NodeOrder& order) const override {
    return split_placement(tree, order, kNodeBytes, kNodeBytes);
  }

  mem::HostBlock encode(const BuildTree& tree, const Placement& placement, uint32_t threads) const override {
    return encoded(tree, placement, threads, [&](const BuildTree::Node& from) {
      const auto children = children_of(tree, from);
      std::array<Bounds, kWidth> bounds;
      for (size_t i = 0; i < children.size(); ++i) bounds[i] = tree.nodes[children[i]].bounds;
      Node node;
      Grid grid;
      std::array<std::array<uint16_t, kWidth>, 3> low{}, high{};
      for (size_t a = 0; a < 3; ++a) {
        quantise<kSteps, uint16_t>({bounds.data(), children.size()}, a, grid, {low[a], high[a]});
        node.exponents_and_count |= uint32_t(grid.exponent[a]) << 8 * a;
      }
      node.origin = grid.origin;
      node.exponents_and_count |= uint32_t(children.size() - 1) << kCountShift;
      for (size_t i = 0; i < children.size(); ++i) {
        const NodeKind kind = tree.nodes[children[i]].kind;
        uint32_t& first = kind == NodeKind::Internal ? node.first_node : node.first_leaf;
        if (first == 0) first = placement.block[children[i]];
        const auto lower = [&](size_t a) { return std::min<uint32_t>(low[a][i], kSteps - 1); };
        const auto upper = [&](size_t a) { return std::max<uint32_t>(high[a][i], 1) - 1; };
        const uint32_t size = bytes_of(tree.nodes[children[i]], kNodeBytes) / kLeafBytes;
        node.child[i] = {lower(0) | lower(1) << kBits, lower(2) | upper(0) << kBits,
                         upper(1) | upper(2) << kBits | uint32_t(kind) << kKindShift | size << kSizeShift};
      }
      return node;
    });
  }

  uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) const override {
    const auto node = load<Node>(bytes);
    const References references(bytes);
    const Planes planes(node);
    const uint32_t count = num_children(node.exponents_and_count);
    for (uint32_t i = 0; i < count; ++i) {
      out[i].node = references[int(i)];
      for (size_t a = 0; a < 3; ++a) {
        out[i].bounds.low[a] = planes.at(node, a, planes.low[a][i]);
        out[i].bounds.high[a] = planes.at(node, a, planes.high[a][i]);
      }
    }
    return count;
  }

  static uint32_t test(const std::byte* bytes, const RaySpace& space, float t_min, float t_max,
                       float* t_enter, uint32_t& box_tests) {
    const auto node = load<Node>(bytes);
    const Planes planes(node);
    const uint32_t count = num_children(node.exponents_and_count);
    uint32_t entered = 0;
    for (size_t half = 0; half < 2; ++half) {
      Four t_near = all<Four>(-__builtin_inff()), t_far = all<Four>(__builtin_inff());
      for (size_t a = 0; a < 3; ++a) {
        const bool backward = std::signbit(space.inverse_direction[a]);
        const auto &near = backward ? planes.high[a] : planes.low[a],
                   &far = backward ? planes.low[a] : planes.high[a];
        const Four origin = all<Four>(node.origin[a]), step = all<Four>(planes.step(node, a));
        clip_slab(origin + four(near, half) * step, origin + four(far, half) * step, space.origin[a],
                  space.inverse_direction[a], t_near, t_far);
      }
      clip_to_ray(t_min, t_max, t_near, t_far);
      std::memcpy(t_enter + 4 * half, &t_near, sizeof t_near);
      entered |= mask_of(t_near <= t_far) << 4 * half;
    }
    box_tests += count;
    return entered & ((1u << count) - 1);
  }

  // Children of each sort, nodes and leaves, follow each other without gaps.
  class References {
   public:
    explicit References(const std::byte* node) : node_(node) {}
    NodeRef operator[](int child) const {
      const uint32_t last = word(child);
      const bool is_inner = kind(last) == NodeKind::Internal;
      uint32_t block =
          load<uint32_t>(node_ + (is_inner ? offsetof(Node, first_node) : offsetof(Node, first_leaf)));
      for (int i = 0; i < child; ++i)
        if (const uint32_t before = word(i); (kind(before) == NodeKind::Internal) == is_inner)
          block += (before >> kSizeShift) * (kLeafBytes / kBlockBytes);
      return node_ref(block, kind(last));
    }

   private:
    uint32_t word(int child) const {
      return load<uint32_t>(node_ + offsetof(Node, child) + size_t(child) * 12 + 8);
    }
    static NodeKind kind(uint32_t last) { return NodeKind(last >> kKindShift & 7); }
    const std::byte* node_;
  };

 private:
  static constexpr uint32_t kBits = 12, kSteps = 1u << kBits;
  static constexpr uint32_t kKindShift = 24, kSizeShift = 28, kCountShift = 28;

  // Bytes that a shader has overwritten may say anything.
  static uint32_t num_children(uint32_t exponents_and_count) {
    return std::min<uint32_t>(((exponents_and_count >> kCountShift) + 1) & 15, kWidth);
  }

  // Holds the numbers of all planes, in steps from the origin.
  struct Planes {
    explicit Planes(const Node& node) {
      constexpr uint32_t kMask = kSteps - 1;
      for (size_t i = 0; i < kWidth; ++i) {
        const auto& w = node.child[i];
        low[0][i] = float(w[0] & kMask), low[1][i] = float(w[0] >> kBits & kMask);
        low[2][i] = float(w[1] & kMask), high[0][i] = float((w[1] >> kBits & kMask) + 1);
        high[1][i] = float((w[2] & kMask) + 1), high[2][i] = float((w[2] >> kBits & kMask) + 1);
      }
    }
    static float step(const Node& node, size_t a) {
      return Grid::step(uint8_t(node.exponents_and_count >> 8 * a));
    }
    static float at(const Node& node, size_t a, float number) {
      return node.origin[a] + number * step(node, a);
    }
    float low[3][kWidth], high[3][kWidth];
  };
  static Four four(const float (&numbers)[kWidth], size_t half) {
    Four out;
    std::memcpy(&out, numbers + 4 * half, sizeof out);
    return out;
  }
};

const Register<NodeFormat, Bvh8In12Bits> registered;

}  // namespace
}  // namespace glint::rt
