// Tests, writes and decodes nodes with boxes in 8 bits per plane, for all formats of that kind.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "rtunit/formats/quantise.h"
#include "rtunit/intersection/box_test.h"
#include "rtunit/intersection/ray_space.h"
#include "rtunit/structure/placement.h"
#include "rtunit/traversal/format_of.h"

namespace glint::rt {

// Handles the bytes of a word at a time, the lowest first.
namespace word_bytes {
inline constexpr uint64_t kOnes = 0x0101'0101'0101'0101;
// Returns 1 in each byte that equals `value`. All bytes and the value are below 8.
constexpr uint64_t equal(uint64_t bytes, uint64_t value) {
  return (8 * kOnes - (bytes ^ value * kOnes)) >> 3 & kOnes;
}
// Returns in each byte the sum of the bytes below it. The sum of all stays below 256.
constexpr uint64_t sums_below(uint64_t bytes) {
  return (bytes << 8) * kOnes;
}
constexpr uint32_t get(uint64_t bytes, int i) {
  return uint32_t(bytes >> 8 * i & 0xff);
}
}  // namespace word_bytes

// A format derives from QuantisedBoxes<itself>. Besides what rtunit/traversal/format_of.h asks for, it has a
// Node with origin, exponent, low and high. One that has num_children and kind, too, can use encode_linked();
// another hides present().
template <class Format>
class QuantisedBoxes : public FormatOf<Format> {
 public:
  static constexpr int kPlanes = 8;

  // Returns the kinds of a node's children, a byte each. What lies behind the last child means nothing.
  static uint64_t kinds(const std::byte* node) {
    return load<uint64_t>(node + offsetof(typename Format::Node, kind)) & 7 * word_bytes::kOnes;
  }

  // Says which children a node has.
  struct Present {
    uint32_t mask, count;
  };
  static Present present(const std::byte* node) {
    const int count = num_children(uint8_t(node[offsetof(typename Format::Node, num_children)]));
    return {(1u << count) - 1, uint32_t(count)};
  }

  // Planes of missing children are whatever follows in the node, and nobody looks at what they give.
  static uint32_t test(const std::byte* bytes, const RaySpace& space, float t_min, float t_max,
                       float* t_enter, uint32_t& box_tests) {
    using Node = typename Format::Node;
    constexpr ptrdiff_t kHigher = offsetof(Node, high) - offsetof(Node, low);
    Four t_near[2], t_far[2];
    for (int half = 0; half < 2; ++half)
      t_near[half] = all<Four>(-__builtin_inff()), t_far[half] = all<Four>(__builtin_inff());
    const auto* origin = bytes + offsetof(Node, origin);
    for (size_t a = 0; a < 3; ++a) {
      const auto* low = bytes + offsetof(Node, low) + a * Format::kWidth;
      const ptrdiff_t backward = kHigher * ptrdiff_t(is_negative(space.inverse_direction[a]));
      const Four start = all<Four>(load<float>(origin + a * sizeof(float)));
      const Four step = all<Four>(Grid::step(uint8_t(bytes[offsetof(Node, exponent) + a])));
      const Numbers near_q = numbers(low + backward), far_q = numbers(low + (kHigher - backward));
      for (int half = 0; half < 2; ++half)
        clip_slab(start + near_q.half[half] * step, start + far_q.half[half] * step, space.origin[a],
                  space.inverse_direction[a], t_near[half], t_far[half]);
    }
    for (int half = 0; half < 2; ++half) clip_to_ray(t_min, t_max, t_near[half], t_far[half]);
    std::memcpy(t_enter, t_near, sizeof t_near);
    const Present children = Format::present(bytes);
    box_tests += children.count;
    return (mask_of(t_near[0] <= t_far[0]) | mask_of(t_near[1] <= t_far[1]) << 4) & children.mask;
  }

  // Returns a node of the tree without its references.
  static auto boxes_of(const BuildTree& tree, const BuildTree::Node& from) {
    std::array<Bounds, kPlanes> bounds;
    typename Format::Node node;
    for (uint32_t index : children_of(tree, from)) {
      bounds[node.num_children] = tree.nodes[index].bounds;
      node.kind[node.num_children++] = uint8_t(tree.nodes[index].kind);
    }
    Grid grid;
    const std::span boxes(bounds.data(), node.num_children);
    for (size_t a = 0; a < 3; ++a)
      quantise<kMostInByte, uint8_t>(boxes, a, grid, {node.low[a], node.high[a]});
    node.origin = grid.origin;
    node.exponent = grid.exponent;
    return node;
  }

  // Returns the bytes of the whole structure. It calls link(node, children) to set a node's references.
  template <class Link>
  static mem::HostBlock encode_linked(const BuildTree& tree, const Placement& placement, uint32_t threads,
                                      Link link) {
    return encoded(tree, placement, threads, [&](const BuildTree::Node& from) {
      typename Format::Node node = boxes_of(tree, from);
      link(node, children_of(tree, from));
      return node;
    });
  }

  uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) const override {
    typename Format::Node node;
    std::memcpy(&node, bytes, sizeof node);
    const Grid grid{node.origin, node.exponent};
    const typename Format::References references(bytes);
    uint32_t count = 0;
    for (uint32_t rest = Format::present(bytes).mask; rest; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      DecodedChild& child = out[count++];
      child.node = references[i];
      for (size_t a = 0; a < 3; ++a) {
        child.bounds.low[a] = Grid::plane(node.origin[a], node.low[a][i], grid.step(a));
        child.bounds.high[a] = Grid::plane(node.origin[a], node.high[a][i], grid.step(a));
      }
    }
    return count;
  }

 private:
  // Holds the numbers of eight planes.
  struct Numbers {
    Four half[2];
  };
  static Numbers numbers(const std::byte* planes) {
    using Longs = uint64_t __attribute__((vector_size(16)));
    using Bytes = uint8_t __attribute__((vector_size(16)));
    using Shorts = uint16_t __attribute__((vector_size(16)));
    using Ints = int32_t __attribute__((vector_size(16)));
    const auto bytes = Bytes(Longs{load<uint64_t>(planes), 0});
    const auto shorts = Shorts(
        __builtin_shufflevector(bytes, Bytes{}, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
    const auto low = Ints(__builtin_shufflevector(shorts, Shorts{}, 0, 8, 1, 9, 2, 10, 3, 11)),
               high = Ints(__builtin_shufflevector(shorts, Shorts{}, 4, 12, 5, 13, 6, 14, 7, 15));
    return {{__builtin_convertvector(low, Four), __builtin_convertvector(high, Four)}};
  }
  // Returns 1 or 0. A branch on the sign could not be foreseen.
  static uint32_t is_negative(float x) { return std::bit_cast<uint32_t>(x) >> 31; }
  // Bytes that a shader has overwritten may say anything.
  static int num_children(uint8_t written) { return written < Format::kWidth ? written : Format::kWidth; }
};

}  // namespace glint::rt
