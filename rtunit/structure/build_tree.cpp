// Calls Embree's builder and flattens what it returns.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/build_tree.h"

#if __has_include(<embree4/rtcore.h>)  // Ubuntu 24.04 has version 4. Building is the same in both.
#include <cstdint>
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/parallel_ranges.h"

namespace glint::rt {
namespace {

constexpr uint32_t kMaxDepth = 60;  // binary levels: the builder's own limit for skewed input

static_assert(sizeof(BuildItem) == sizeof(RTCBuildPrimitive) &&
              alignof(BuildItem) == alignof(RTCBuildPrimitive));
static_assert(offsetof(BuildItem, high) == offsetof(RTCBuildPrimitive, upper_x));
static_assert(offsetof(BuildItem, leaf) == offsetof(RTCBuildPrimitive, primID));

struct RawNode;

// Refers to a node in the builder's memory, or to an item, which is a leaf.
class RawChild {
 public:
  explicit RawChild(const void* from) : from_(reinterpret_cast<uintptr_t>(from)) {}
  // Items have an address that is a multiple of 32, and the builder's nodes of 8, so the lowest bit is free.
  static void* leaf(const RTCBuildPrimitive* item) {
    return reinterpret_cast<void*>(reinterpret_cast<uintptr_t>(item) | 1);
  }
  bool is_leaf() const { return from_ & 1; }
  const BuildItem& item() const { return *reinterpret_cast<const BuildItem*>(from_ & ~uintptr_t{1}); }
  const RawNode& node() const { return *reinterpret_cast<const RawNode*>(from_); }
  uint32_t num_below() const;

 private:
  uintptr_t from_;
};

// Holds a node in the builder's memory. The builder allots as many children as the node has.
struct RawNode {
  uint32_t num_children = 0;
  uint32_t num_below = 0;  // nodes and leaves below it
  const void* child[1];

  RawChild operator[](uint32_t i) const { return RawChild(child[i]); }
};

uint32_t RawChild::num_below() const {
  return is_leaf() ? 0 : node().num_below;
}

void* create_node(RTCThreadLocalAllocator allocator, unsigned count, void*) {
  const size_t bytes = offsetof(RawNode, child) + count * sizeof(void*);
  auto* node = static_cast<RawNode*>(rtcThreadLocalAlloc(allocator, bytes, alignof(RawNode)));
  node->num_children = count;
  return node;
}
void set_children(void* to, void** children, unsigned count, void*) {
  auto* node = static_cast<RawNode*>(to);
  node->num_below = count;
  for (unsigned i = 0; i < count; ++i) {
    node->child[i] = children[i];
    node->num_below += RawChild(children[i]).num_below();
  }
}
void set_bounds(void*, const RTCBounds**, unsigned, void*) {
}  // recomputed from the leaves below
void* create_leaf(RTCThreadLocalAllocator, const RTCBuildPrimitive* primitives, size_t count, void* user) {
  GLINT_CHECK_EQ(count, size_t{1});
  const auto& items = *static_cast<const std::span<BuildItem>*>(user);
  const auto* item = reinterpret_cast<const BuildItem*>(primitives);
  GLINT_CHECK(item >= items.data() && item < items.data() + items.size(), "a leaf of {} is none of them",
              items.size());
  return RawChild::leaf(primitives);
}

// Numbers nodes and copies them into a tree.
class Flattener {
 public:
  explicit Flattener(BuildTree& tree) : tree_(tree) {}

  void run(const RawNode& root, uint32_t threads) {
    tree_.nodes = mem::HostArray<BuildTree::Node>(size_t{1} + root.num_below);
    tree_.children = mem::HostArray<uint32_t>(root.num_below);
    // The tree is cut at subtrees that one thread flattens. Where it is cut does not depend on threads.
    std::vector<Work> top{{&root, 0, 1}}, parts;
    std::vector<uint32_t> above;  // the nodes above the parts, parents first
    while (!top.empty()) {
      const Work work = top.back();
      top.pop_back();
      if (work.from->num_below <= kPart) {
        parts.push_back(work);
        continue;
      }
      above.push_back(work.to);
      add_children(work, top);
    }
    parallel_ranges(parts.size(), 1, threads, [&](size_t i, size_t) { flatten(parts[i]); });
    for (size_t i = above.size(); i-- > 0;) set_bounds_of(above[i]);
  }

 private:
  static constexpr uint32_t kPart = 8192;  // nodes below the largest part

  struct Work {
    const RawNode* from;
    uint32_t to;
    uint32_t below;  // number of the first node below it
  };

  // Numbers the children of a node, writes those that are leaves, and appends the others to `next`, the first
  // one last.
  void add_children(const Work& work, std::vector<Work>& next) {
    const RawNode& from = *work.from;
    const uint32_t first = work.below, count = from.num_children;
    BuildTree::Node& node = tree_.nodes[work.to];
    node.first_child = first - 1;  // The root is no child, so child number n is node n + 1.
    node.num_children = uint8_t(count);
    uint32_t end = work.below + from.num_below;
    for (uint32_t i = count; i-- > 0;) {
      tree_.children[first - 1 + i] = first + i;
      end -= from[i].num_below();
      if (from[i].is_leaf())
        write_leaf(from[i].item(), tree_.nodes[first + i]);
      else
        next.push_back({&from[i].node(), first + i, end});
    }
  }

  static void write_leaf(const BuildItem& item, BuildTree::Node& node) {
    node.bounds = item.bounds();
    node.kind = kind_of(item.leaf);
    node.leaf_block = block_of(item.leaf);
  }

  void flatten(const Work& part) {
    std::vector<Work> stack{part};
    while (!stack.empty()) {
      const Work work = stack.back();
      stack.pop_back();
      add_children(work, stack);
    }
    for (uint32_t n = part.below + part.from->num_below; n-- > part.below;) set_bounds_of(n);
    set_bounds_of(part.to);
  }

  void set_bounds_of(uint32_t n) {
    BuildTree::Node& node = tree_.nodes[n];
    if (node.kind != NodeKind::Internal) return;
    node.bounds = empty_bounds();
    for (uint32_t i = 0; i < node.num_children; ++i)
      extend(node.bounds, tree_.nodes[tree_.children[node.first_child + i]].bounds);
  }

  BuildTree& tree_;
};

// Holds Embree's device and the memory of its nodes.
class Builder {
 public:
  explicit Builder(uint32_t threads)
      : device_(rtcNewDevice(fmt::format("threads={},ignore_config_files=1", threads).c_str())) {
    GLINT_CHECK(device_, "Embree does not start: error {}", int(rtcGetDeviceError(nullptr)));
    bvh_ = rtcNewBVH(device_);
  }
  ~Builder() {
    rtcReleaseBVH(bvh_);
    rtcReleaseDevice(device_);
  }
  Builder(const Builder&) = delete;
  Builder& operator=(const Builder&) = delete;

  // Splits depend on counts and bounds only, and where these decide nothing, items are sorted by their
  // number. So threads do not show in the tree.
  const RawNode& build(std::span<BuildItem> items, uint32_t width) {
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    // The builder uses a binned SAH without spatial splits, so it places each primitive once.
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = width;  // opens the child of largest area until the node is full
    arguments.maxDepth = kMaxDepth;
    arguments.maxLeafSize = 1;
    arguments.bvh = bvh_;
    arguments.primitives = reinterpret_cast<RTCBuildPrimitive*>(items.data());
    arguments.primitiveCount = arguments.primitiveArrayCapacity = items.size();
    arguments.userPtr = &items;
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    const void* root = rtcBuildBVH(&arguments);
    GLINT_CHECK(root, "Embree cannot build a tree of {} leaves: error {}", items.size(),
                int(rtcGetDeviceError(device_)));
    return *static_cast<const RawNode*>(root);
  }

 private:
  RTCDevice device_;
  RTCBVH bvh_;
};

// Makes the nodes of a balanced tree.
class BalancedBuilder {
 public:
  explicit BalancedBuilder(uint32_t width) : width_(width) {}

  const RawNode& build(std::span<BuildItem> items) {
    std::vector<const void*> children;
    split(items, uint32_t(std::min<size_t>(width_, items.size())), children);
    nodes_.push_back(std::make_unique<uint64_t[]>(1 + children.size()));
    auto* node = reinterpret_cast<RawNode*>(nodes_.back().get());
    node->num_children = uint32_t(children.size());
    set_children(node, const_cast<void**>(children.data()), unsigned(children.size()), nullptr);
    return *node;
  }

 private:
  // Appends `parts` nodes or leaves that hold the items.
  void split(std::span<BuildItem> items, uint32_t parts, std::vector<const void*>& out) {
    if (items.size() == 1) {
      out.push_back(RawChild::leaf(reinterpret_cast<const RTCBuildPrimitive*>(items.data())));
      return;
    }
    if (parts == 1) {
      out.push_back(&build(items));
      return;
    }
    Bounds middles = empty_bounds();
    for (const BuildItem& item : items) extend(middles, {middle(item), middle(item)});
    size_t axis = 0;
    for (size_t a = 1; a < 3; ++a)
      if (middles.high[a] - middles.low[a] > middles.high[axis] - middles.low[axis]) axis = a;
    const size_t first = items.size() * (parts / 2) / parts;
    std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(first), items.end(),
                     [&](const BuildItem& a, const BuildItem& b) {
                       return std::pair(middle(a)[axis], a.leaf) < std::pair(middle(b)[axis], b.leaf);
                     });
    split(items.subspan(0, first), parts / 2, out);
    split(items.subspan(first), parts - parts / 2, out);
  }
  static std::array<float, 3> middle(const BuildItem& item) {
    return {item.low[0] / 2 + item.high[0] / 2, item.low[1] / 2 + item.high[1] / 2,
            item.low[2] / 2 + item.high[2] / 2};
  }

  uint32_t width_;
  std::vector<std::unique_ptr<uint64_t[]>> nodes_;
};

}  // namespace

Bounds empty_bounds() {
  constexpr float kMost = std::numeric_limits<float>::max();
  return {{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};
}

void build_tree(std::span<BuildItem> items, uint32_t width, uint32_t threads, BuildTree& tree) {
  GLINT_CHECK_LE(width, kMaxWidth);
  Flattener flattener(tree);
  if (items.empty()) {
    tree.nodes = mem::HostArray<BuildTree::Node>(1);
    tree.nodes[0].bounds = empty_bounds();
    tree.children = {};
  } else if (items.size() == 1) {  // The root holds the one leaf.
    RawNode root{1, 1, {RawChild::leaf(reinterpret_cast<const RTCBuildPrimitive*>(items.data()))}};
    flattener.run(root, 1);
  } else {
    Builder builder(threads);
    flattener.run(builder.build(items, width), threads);
  }
}

// The items come in an order that threads may have changed.
void build_balanced_tree(std::span<BuildItem> items, uint32_t width, BuildTree& tree) {
  GLINT_CHECK(items.size() > 1, "a tree of {} leaves is never too deep", items.size());
  std::sort(items.begin(), items.end(),
            [](const BuildItem& a, const BuildItem& b) { return a.leaf < b.leaf; });
  tree = {};
  BalancedBuilder builder(width);
  Flattener(tree).run(builder.build(items), 1);
}

}  // namespace glint::rt
