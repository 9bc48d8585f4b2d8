// Tests, writes and decodes nodes with boxes in 8 bits per plane, for all formats of that kind.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "rtunit/formats/quantise.h"
#include "rtunit/intersection/box_test.h"
#include "rtunit/intersection/ray_space.h"
#include "rtunit/structure/layout.h"

namespace glint::rt {

// A format has kWidth; a Node with origin, exponent, num_children, kind, low and high; and References, whose
// next(i) returns the reference of child i and is called in the order of the children.
template <class Format>
struct QuantisedBoxes {
  // This many planes fill two SIMD registers of single precision. Planes of missing children are zeros, and
  // nobody looks at what they give.
  static constexpr int kPlanes = 8;

  // Writes the children that the ray enters in [t_min, t_max], in index order. Returns their number and
  // counts the tests.
  static int test(const std::byte* bytes, const RaySpace& space, float t_min, float t_max, float* t_enter,
                  NodeRef* child, uint32_t& box_tests) {
    typename Format::Node node;
    std::memcpy(&node, bytes, sizeof node);
    float t_near[kPlanes], t_far[kPlanes];
    for (int i = 0; i < kPlanes; ++i) t_near[i] = -__builtin_inff(), t_far[i] = __builtin_inff();
    const Grid grid{node.origin, node.exponent};
    for (size_t a = 0; a < 3; ++a) {
      const bool backward = std::signbit(space.inverse_direction[a]);
      uint8_t near_q[kPlanes], far_q[kPlanes];
      std::memcpy(near_q, backward ? node.high[a] : node.low[a], Format::kWidth);
      std::memcpy(far_q, backward ? node.low[a] : node.high[a], Format::kWidth);
      for (int i = Format::kWidth; i < kPlanes; ++i) near_q[i] = far_q[i] = 0;
      const float step = grid.step(a);
      for (int i = 0; i < kPlanes; ++i)
        clip_slab(Grid::plane(node.origin[a], near_q[i], step), Grid::plane(node.origin[a], far_q[i], step),
                  space.origin[a], space.inverse_direction[a], t_near[i], t_far[i]);
    }
    for (int i = 0; i < kPlanes; ++i) clip_to_ray(t_min, t_max, t_near[i], t_far[i]);
    const int count = num_children(node);
    box_tests += uint32_t(count);
    int hits = 0;
    typename Format::References references(node);
    // A child is written in any case, and kept if it is entered: a branch could not be foreseen.
    for (int i = 0; i < count; ++i) {
      t_enter[hits] = t_near[i];
      child[hits] = references.next(i);
      hits += t_near[i] <= t_far[i];
    }
    return hits;
  }

  // Returns a node of the tree without its references.
  static auto boxes_of(const BuildTree& tree, const BuildTree::Node& from) {
    const std::vector<Bounds> boxes = bounds_of_children(tree, from);
    typename Format::Node node;
    Grid grid;
    for (size_t a = 0; a < 3; ++a) quantise(boxes, a, grid, {node.low[a], node.high[a]});
    node.origin = grid.origin;
    node.exponent = grid.exponent;
    for (uint32_t index : children_of(tree, from))
      node.kind[node.num_children++] = uint8_t(tree.nodes[index].kind);
    return node;
  }

  // Returns the bytes of the whole structure. It calls link(node, children) to set a node's references.
  template <class Link>
  static std::vector<std::byte> encode(const BuildTree& tree, const Layout& layout, Link link) {
    std::vector<std::byte> out = bytes_with_leaves(tree, layout);
    for (size_t n = 0; n < tree.nodes.size(); ++n) {
      if (tree.nodes[n].kind != NodeKind::Internal) continue;
      typename Format::Node node = boxes_of(tree, tree.nodes[n]);
      link(node, children_of(tree, tree.nodes[n]));
      std::memcpy(&out[size_t(layout.block[n]) * kBlockBytes], &node, sizeof node);
    }
    return out;
  }

  static uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) {
    typename Format::Node node;
    std::memcpy(&node, bytes, sizeof node);
    const Grid grid{node.origin, node.exponent};
    typename Format::References references(node);
    const int count = num_children(node);
    for (int i = 0; i < count; ++i) {
      DecodedChild& child = out[size_t(i)];
      child.node = references.next(i);
      for (size_t a = 0; a < 3; ++a) {
        child.bounds.low[a] = Grid::plane(node.origin[a], node.low[a][i], grid.step(a));
        child.bounds.high[a] = Grid::plane(node.origin[a], node.high[a][i], grid.step(a));
      }
    }
    return uint32_t(count);
  }

 private:
  // Bytes that a shader has overwritten may say anything.
  template <class Node>
  static int num_children(const Node& node) {
    return node.num_children < Format::kWidth ? node.num_children : Format::kWidth;
  }
};

}  // namespace glint::rt
