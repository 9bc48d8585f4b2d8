// Calls Embree's builder on one thread and flattens what it returns.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/build_tree.h"

#if __has_include(<embree4/rtcore.h>)  // Ubuntu 24.04 has version 4. Building is the same in both.
#include <cstdint>
#include <embree4/rtcore.h>
#include <vector>
#else
#include <embree3/rtcore.h>
#endif

#include <limits>

#include "base/check.h"

namespace glint::rt {
namespace {

constexpr uint32_t kMaxDepth = 60;  // binary levels: the builder's own limit for skewed input

// Holds a node in the builder's memory. It is a leaf when `num_children` is 0.
struct RawNode {
  uint32_t num_children = 0, item = 0;
  RawNode* child[kMaxWidth]{};
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned count, void*) {
  auto* node = new (rtcThreadLocalAlloc(allocator, sizeof(RawNode), alignof(RawNode))) RawNode;
  node->num_children = count;
  return node;
}
void set_children(void* node, void** children, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i)
    static_cast<RawNode*>(node)->child[i] = static_cast<RawNode*>(children[i]);
}
void set_bounds(void*, const RTCBounds**, unsigned, void*) {
}  // } // recomputed from the leaves below
void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count,
                  void*) {
  GLINT_CHECK_EQ(count, size_t{1});
  auto* node = new (rtcThreadLocalAlloc(allocator, sizeof(RawNode), alignof(RawNode))) RawNode;
  node->item = primitives[0].primID;
  return node;
}

// Numbers nodes in preorder: a node's index is below its children's.
void flatten(const RawNode* root, std::span<const BuildItem> items, BuildTree& tree) {
  struct Work {
    const RawNode* from;
    uint32_t to;
  };
  std::vector<Work> stack{{root, 0}};
  tree.nodes.emplace_back();
  while (!stack.empty()) {
    const Work work = stack.back();
    stack.pop_back();
    if (work.from->num_children == 0) {
      const BuildItem& item = items[work.from->item];
      tree.nodes[work.to] = {item.bounds, item.kind, 0, 0, item.leaf_block};
      continue;
    }
    tree.nodes[work.to].first_child = uint32_t(tree.children.size());
    tree.nodes[work.to].num_children = work.from->num_children;
    for (uint32_t i = 0; i < work.from->num_children; ++i) {
      const uint32_t child = uint32_t(tree.nodes.size());
      tree.children.push_back(child);
      tree.nodes.emplace_back();
      stack.push_back({work.from->child[i], child});
    }
  }
  for (size_t n = tree.nodes.size(); n-- > 0;) {
    BuildTree::Node& node = tree.nodes[n];
    if (node.kind != NodeKind::Internal) continue;
    node.bounds = empty_bounds();
    for (uint32_t i = 0; i < node.num_children; ++i)
      extend(node.bounds, tree.nodes[tree.children[node.first_child + i]].bounds);
  }
}

std::vector<RTCBuildPrimitive> primitives_of(std::span<const BuildItem> items) {
  std::vector<RTCBuildPrimitive> out(items.size());
  for (size_t i = 0; i < items.size(); ++i) {
    const auto& [low, high] = items[i].bounds;
    out[i] = {low[0], low[1], low[2], 0, high[0], high[1], high[2], uint32_t(i)};
  }
  return out;
}

}  // namespace

Bounds empty_bounds() {
  constexpr float kMost = std::numeric_limits<float>::max();
  return {{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};
}
void extend(Bounds& bounds, const Bounds& other) {
  for (size_t a = 0; a < 3; ++a) {
    bounds.low[a] = bounds.low[a] < other.low[a] ? bounds.low[a] : other.low[a];
    bounds.high[a] = bounds.high[a] > other.high[a] ? bounds.high[a] : other.high[a];
  }
}

void build_tree(std::span<const BuildItem> items, uint32_t width, BuildTree& tree) {
  GLINT_CHECK_LE(width, kMaxWidth);
  tree.nodes.clear();
  tree.children.clear();
  if (items.size() < 2) {  // The root holds the one leaf, or nothing.
    RawNode leaf, root;
    root.num_children = 1;
    root.child[0] = &leaf;
    if (!items.empty()) return flatten(&root, items, tree);
    tree.nodes.push_back({empty_bounds()});
    return;
  }
  // With one thread, partitions keep their order, so the tree is the same in every run.
  const RTCDevice device = rtcNewDevice("threads=1,ignore_config_files=1");
  GLINT_CHECK(device, "Embree does not start: error {}", int(rtcGetDeviceError(nullptr)));
  const RTCBVH bvh = rtcNewBVH(device);
  std::vector<RTCBuildPrimitive> primitives = primitives_of(items);
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  // The builder uses a binned SAH without spatial splits, so it places each primitive once.
  arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
  arguments.maxBranchingFactor = width;  // opens the child of largest area until the node is full
  arguments.maxDepth = kMaxDepth;
  arguments.maxLeafSize = 1;
  arguments.bvh = bvh;
  arguments.primitives = primitives.data();
  arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = create_node;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = create_leaf;
  const void* root = rtcBuildBVH(&arguments);
  GLINT_CHECK(root, "Embree cannot build a tree of {} leaves: error {}", items.size(),
              int(rtcGetDeviceError(device)));
  flatten(static_cast<const RawNode*>(root), items, tree);
  rtcReleaseBVH(bvh);
  rtcReleaseDevice(device);
}

}  // namespace glint::rt
