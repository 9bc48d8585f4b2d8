// Implements the node format `box32`: the four boxes of `bvh4`, child by child behind their references.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstring>

#include "rtunit/intersection/box_test.h"
#include "rtunit/intersection/ray_space.h"
#include "rtunit/structure/placement.h"
#include "rtunit/traversal/format_of.h"

namespace glint::rt {
namespace {

// AMD's GPUs up to RDNA 3 have the fields in this order (Mesa, src/amd/vulkan/bvh/bvh.h,
// radv_bvh_box32_node).
class Box32 final : public FormatOf<Box32> {
 public:
  static constexpr std::string_view kName = "box32";
  static constexpr std::string_view kDoc = "Internal nodes have 128 B: four references, and then four boxes.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Box32(Params, Context) {}

  static constexpr int kWidth = 4, kPlanes = 4;
  struct Node {
    std::array<NodeRef, kWidth> child{};  // The children that exist come first. 0: there is none.
    std::array<Bounds, kWidth> box{};
    std::array<uint32_t, 4> reserved{};
  };
  static constexpr uint32_t kNodeBytes = sizeof(Node);
  static_assert(kNodeBytes == 128);

  // Bytes: nodes and leaves lie one behind the other.
  Placement place(const BuildTree& tree, const NodeOrder& order) const override {
    return mixed_placement(tree, order, kNodeBytes);
  }
  mem::HostBlock encode(const BuildTree& tree, const Placement& placement, uint32_t threads) const override {
    return encoded(tree, placement, threads, [&](const BuildTree::Node& from) {
      Node node;
      size_t i = 0;
      for (const uint32_t index : children_of(tree, from)) {
        node.child[i] = node_ref(placement.block[index], tree.nodes[index].kind);
        node.box[i++] = tree.nodes[index].bounds;
      }
      return node;
    });
  }
  uint32_t decode(const std::byte* bytes, std::span<DecodedChild> out) const override {
    const auto node = load<Node>(bytes);
    uint32_t count = 0;
    for (; count < kWidth && node.child[count]; ++count) out[count] = {node.child[count], node.box[count]};
    return count;
  }

  // Walk: the traversal is compiled with these two.
  class References {
   public:
    explicit References(const std::byte* node) : child_(load<Node>(node).child) {}
    NodeRef operator[](int child) const { return child_[size_t(child)]; }

   private:
    const std::array<NodeRef, kWidth> child_;
  };
  static uint32_t test(const std::byte* bytes, const RaySpace& space, float t_min, float t_max,
                       float* t_enter, uint32_t& box_tests) {
    const auto node = load<Node>(bytes);
    uint32_t entered = 0;
    for (size_t i = 0; i < kWidth && node.child[i]; ++i, ++box_tests) {
      float t_near = -INFINITY, t_far = INFINITY;
      for (size_t a = 0; a < 3; ++a) {
        const bool backward = std::signbit(space.inverse_direction[a]);
        const float low = node.box[i].low[a], high = node.box[i].high[a];
        clip_slab(backward ? high : low, backward ? low : high, space.origin[a], space.inverse_direction[a],
                  t_near, t_far);
      }
      clip_to_ray(t_min, t_max, t_near, t_far);
      t_enter[i] = t_near;
      entered |= uint32_t(t_near <= t_far) << i;
    }
    return entered;
  }
};

const Register<NodeFormat, Box32> registered;

}  // namespace
}  // namespace glint::rt
