// Fits structures to geometry that has moved.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/refit.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <mutex>
#include <optional>
#include <utility>

#include "base/check.h"
#include "base/parallel_ranges.h"
#include "rtunit/structure/build_tree.h"
#include "rtunit/structure/input_primitives.h"
#include "rtunit/structure/top_leaves.h"

namespace glint::rt {
namespace {

constexpr size_t kRange = 16384;  // nodes that a thread takes at a time
constexpr const char* kGone = "is gone or is not finite";

std::string about(const char* kind, uint32_t primitive, uint32_t geometry, const char* what) {
  return fmt::format("{} {} of geometry {} {}", kind, primitive, geometry, what);
}

// Moves the leaves of a bottom level one by one.
class LeafMover {
 public:
  explicit LeafMover(const BottomLevel& moved) : moved_(moved) {}

  // Moves a leaf and finds its box. Returns why it cannot be moved, or "".
  std::string move(TriangleLeaf& leaf, Bounds& box) const {
    const auto first = corners_of(leaf, 0);
    if (!first) return about("triangle", leaf.primitive_of(0), leaf.geometry, kGone);
    std::copy(first->begin(), first->end(), leaf.vertex.begin());
    leaf.vertex[3] = (*first)[2];
    box = bounds_of(*first);
    if (leaf.count < 2) return "";
    const auto second = corners_of(leaf, 1);
    if (!second) return about("triangle", leaf.primitive_of(1), leaf.geometry, kGone);
    for (size_t corner = 0; corner < 3; ++corner) {
      const size_t vertex = leaf.second >> 2 * corner & 3;
      if (vertex == 3)
        leaf.vertex[3] = (*second)[corner];
      else if ((*first)[vertex] != (*second)[corner])
        return about("triangle", leaf.primitive_of(1), leaf.geometry,
                     "has left the triangle with which it shares a leaf");
    }
    extend(box, bounds_of(*second));
    return "";
  }
  std::string move(ProceduralLeaf& leaf, Bounds& box) const {
    const bool is_there = leaf.geometry < moved_.geometries.size() &&
                          leaf.primitive < moved_.geometries[leaf.geometry].aabbs.size();
    if (!is_there || !is_active(moved_.geometries[leaf.geometry].aabbs[leaf.primitive]))
      return about("box", leaf.primitive, leaf.geometry, kGone);
    box = leaf.box = moved_.geometries[leaf.geometry].aabbs[leaf.primitive];
    return "";
  }

 private:
  std::optional<Triangle> corners_of(const TriangleLeaf& leaf, uint32_t number) const {
    if (leaf.geometry >= moved_.geometries.size()) return {};
    const Geometry& from = moved_.geometries[leaf.geometry];
    if (!from.aabbs.empty() || leaf.primitive_of(number) >= num_primitives(from)) return {};
    return corners_at(from, leaf.primitive_of(number));
  }

  const BottomLevel& moved_;
};

// Notes the first thing that goes wrong on several threads, by the number of the node.
class FirstFailure {
 public:
  void note(size_t node, std::string why) {
    const std::lock_guard lock(mutex_);
    if (why_.empty() || node < node_) node_ = node, why_ = std::move(why);
  }
  const std::string& why() const { return why_; }

 private:
  std::mutex mutex_;
  size_t node_ = 0;
  std::string why_;
};

template <class Leaf>
std::string move_at(const LeafMover& mover, const std::byte* from, std::byte* to, Bounds& box) {
  auto leaf = load<Leaf>(from);
  std::string why = mover.move(leaf, box);
  std::memcpy(to, &leaf, sizeof leaf);
  return why;
}

// Returns why a primitive that has no leaf would need one, or "".
std::string why_more(const KeptTree& kept, const BottomLevel& moved) {
  uint64_t all = 0;
  for (const Geometry& g : moved.geometries) all += num_primitives(g);
  if (all == kept.info.primitives) return "";
  std::vector<std::vector<bool>> has_leaf;
  for (const Geometry& g : moved.geometries) has_leaf.emplace_back(num_primitives(g));
  for (const BuildTree::Node& node : kept.tree.nodes) {
    const std::byte* const at = kept.tree.leaf_bytes.data() + size_t{node.leaf_block} * kBlockBytes;
    if (node.kind == NodeKind::Triangle) {
      const auto leaf = load<TriangleLeaf>(at);
      for (uint32_t i = 0; i < leaf.count; ++i) has_leaf[leaf.geometry][leaf.primitive_of(i)] = true;
    } else if (node.kind == NodeKind::Procedural) {
      const auto leaf = load<ProceduralLeaf>(at);
      has_leaf[leaf.geometry][leaf.primitive] = true;
    }
  }
  for (uint32_t g = 0; g < moved.geometries.size(); ++g) {
    const Geometry& from = moved.geometries[g];
    for (uint32_t i = 0; i < has_leaf[g].size(); ++i) {
      if (has_leaf[g][i]) continue;
      const bool is_now = from.aabbs.empty() ? triangle_at(from, i).has_value() : is_active(from.aabbs[i]);
      if (is_now)
        return about(from.aabbs.empty() ? "triangle" : "box", i, g, "was inactive when it was built");
    }
  }
  return "";
}

// Sets the box of each internal node to hold those of its children, which come after it.
void fit_boxes(BuildTree& tree) {
  for (size_t n = tree.nodes.size(); n-- > 0;) {
    BuildTree::Node& node = tree.nodes[n];
    if (node.kind != NodeKind::Internal) continue;
    node.bounds = empty_bounds();
    for (const uint32_t child : children_of(tree, node)) extend(node.bounds, tree.nodes[child].bounds);
  }
}

// Writes the tree over the structure. The tables behind the nodes stay, because nodes and leaves keep their
// places and their triangles.
void write(KeptTree& kept, uint8_t contents, std::span<std::byte> structure, uint32_t threads) {
  GLINT_CHECK_EQ(structure.size(), kept.info.bytes);
  fit_boxes(kept.tree);
  kept.info.bounds = kept.tree.nodes[0].bounds;
  kept.info.contents = contents;
  auto header = load<StructureHeader>(structure.data());
  header.bounds = kept.info.bounds;
  header.contents = contents;
  const mem::HostBlock bytes = kept.format.make({})->encode(kept.tree, kept.placement, threads);
  const uint64_t end = kBlockBytes * uint64_t{header.treelets    ? header.treelets
                                              : header.micromaps ? header.micromaps
                                                                 : uint32_t(bytes.size() / kBlockBytes)};
  std::memcpy(structure.data() + sizeof header, bytes.data() + sizeof header, end - sizeof header);
  std::memcpy(structure.data(), &header, sizeof header);
}

}  // namespace

std::string refit_bottom(KeptTree& kept, const BottomLevel& moved, std::span<std::byte> structure,
                         uint32_t threads) {
  BuildTree& tree = kept.tree;
  const LeafMover mover(moved);
  mem::HostBlock bytes(tree.leaf_bytes.size());
  mem::HostArray<Bounds> boxes(tree.nodes.size());
  FirstFailure failure;
  parallel_ranges(tree.nodes.size(), kRange, threads, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      const BuildTree::Node& node = tree.nodes[n];
      if (node.kind == NodeKind::Internal) continue;
      const size_t at = size_t{node.leaf_block} * kBlockBytes;
      std::string why =
          node.kind == NodeKind::Triangle
              ? move_at<TriangleLeaf>(mover, tree.leaf_bytes.data() + at, bytes.data() + at, boxes[n])
              : move_at<ProceduralLeaf>(mover, tree.leaf_bytes.data() + at, bytes.data() + at, boxes[n]);
      if (!why.empty()) return failure.note(n, std::move(why));
    }
  });
  if (!failure.why().empty()) return failure.why();
  if (std::string why = why_more(kept, moved); !why.empty()) return why;
  tree.leaf_bytes = std::move(bytes);
  for (size_t n = 0; n < tree.nodes.size(); ++n)
    if (tree.nodes[n].kind != NodeKind::Internal) tree.nodes[n].bounds = boxes[n];
  write(kept, kept.info.contents, structure, threads);
  return "";
}

std::string refit_top(KeptTree& kept, std::span<const Instance> moved, std::span<const StructureInfo> bottoms,
                      std::span<std::byte> structure) {
  BuildTree& tree = kept.tree;
  std::vector<std::string> inactive;
  Leaves leaves = top_leaves("top level", moved, bottoms, kept.info.format, &inactive);
  if (leaves.bytes.size() != tree.leaf_bytes.size()) return "another number of instances is active";
  for (size_t i = 0; i < leaves.items.size(); ++i) {
    const size_t at = i * sizeof(InstanceLeaf);
    const auto was = load<InstanceLeaf>(tree.leaf_bytes.data() + at),
               is = load<InstanceLeaf>(leaves.bytes.data() + at);
    if (is.instance != was.instance) return fmt::format("instance {} was inactive", is.instance);
    if (leaves.stack_need[i] > kept.stack_need[i])
      return fmt::format("the bottom level of instance {} needs more stack entries", is.instance);
  }
  tree.leaf_bytes = std::move(leaves.bytes);
  for (BuildTree::Node& node : tree.nodes)
    if (node.kind == NodeKind::Instance)
      node.bounds = leaves.items[size_t{node.leaf_block} * kBlockBytes / sizeof(InstanceLeaf)].bounds();
  write(kept, leaves.contents, structure, 1);
  return "";
}

}  // namespace glint::rt
