// Node format `bvh6`: 64-byte nodes of six boxes in 8 bits a plane, as Intel's hardware and the published simulators have it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstddef>
#include <cstring>

#include "rtunit/box_test.h"
#include "rtunit/quantise.h"

namespace glint::rt {

struct Bvh6 {
  static constexpr int kWidth = 6;

  struct Node {
    std::array<float, 3> origin{};
    uint32_t first_block = 0;           // of child 0; the others follow without gaps
    std::array<uint8_t, 3> exponent{};
    uint8_t num_children = 0;
    uint8_t low[3][kWidth]{}, high[3][kWidth]{};
    std::array<uint8_t, kWidth> kind{};
    uint8_t pad[2]{};
  };
  static constexpr uint32_t kNodeBytes = sizeof(Node);
  static_assert(kNodeBytes == 64);

  // Internal nodes are as large as leaves: siblings follow each other without gaps.
  static uint32_t blocks_of(NodeKind kind) { return (kind == NodeKind::Internal ? kNodeBytes : leaf_bytes(kind)) / kBlockBytes; }

  // Children that the ray enters in [t_min, t_max], in index order. Returns how many; counts the tests.
  static int test(const std::byte* bytes, const RaySpace& space, float t_min, float t_max, float* t_enter,
                  NodeRef* child, uint32_t& box_tests) {
    Node node;
    std::memcpy(&node, bytes, sizeof node);
    constexpr int kLanes8 = 8;  // two SIMD registers; the last two lanes repeat neighbouring bytes and are ignored
    float t_near[kLanes8], t_far[kLanes8];
    for (int i = 0; i < kLanes8; ++i) t_near[i] = -__builtin_inff(), t_far[i] = __builtin_inff();
    const Grid grid{node.origin, node.exponent};
    for (size_t a = 0; a < 3; ++a) {
      const bool backward = std::signbit(space.inverse_direction[a]);
      uint8_t near_q[kLanes8], far_q[kLanes8];
      std::memcpy(near_q, backward ? node.high[a] : node.low[a], kWidth);
      std::memcpy(far_q, backward ? node.low[a] : node.high[a], kWidth);
      near_q[6] = near_q[7] = far_q[6] = far_q[7] = 0;
      const float s = grid.step(a);
      for (int i = 0; i < kLanes8; ++i)
        clip_slab(Grid::plane(node.origin[a], near_q[i], s), Grid::plane(node.origin[a], far_q[i], s), space.origin[a],
                  space.inverse_direction[a], t_near[i], t_far[i]);
    }
    const int count = node.num_children < kWidth ? node.num_children : kWidth;
    box_tests += uint32_t(count);
    int hits = 0;
    uint32_t block = node.first_block;
    for (int i = 0; i < count; ++i) {
      const NodeKind kind = NodeKind(node.kind[i] & 7);
      float enter = widen_near(t_near[i]), leave = widen_far(t_far[i]);
      enter = enter > t_min ? enter : t_min;
      leave = leave < t_max ? leave : t_max;
      if (enter <= leave) {
        t_enter[hits] = enter;
        child[hits++] = node_ref(block, kind);
      }
      block += blocks_of(kind);
    }
    return hits;
  }
};

}  // namespace glint::rt
