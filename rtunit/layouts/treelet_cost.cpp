// Implements the tree layout `treelet_cost`: treelets are cut so that a ray is expected to enter few of them
// (Aila, Karras: "Architecture Considerations for Tracing Incoherent Rays", HPG 2010).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/registry.h"
#include "rtunit/tree_layout.h"

namespace glint::rt {
namespace {

// The cost of a tree is the sum of its treelets' areas, for a ray enters a treelet about as often as the box
// of its root is large. A little is added to each area, so that treelets are not small where areas are.
// From the leaves up, each node is tried as a root: its treelet grows by the node with the largest gain, and
// the cheapest of the sizes on the way is kept.
class Cutter {
 public:
  Cutter(const BuildTree& tree, uint32_t node_bytes, uint32_t most_bytes)
      : tree_(tree),
        node_bytes_(node_bytes),
        most_bytes_(most_bytes),
        below_(tree.nodes.size()),
        cost_(tree.nodes.size()),
        size_(tree.nodes.size()) {
    for (size_t n = tree.nodes.size(); n-- > 0;) {
      const BuildTree::Node& node = tree.nodes[n];
      below_[n] = bytes_of(node, node_bytes);
      if (node.kind == NodeKind::Internal)
        for (const uint32_t child : children_of(tree, node)) below_[n] += below_[child];
    }
    extra_ = half_area(tree.nodes[0].bounds) * most_bytes / (10 * double(below_[0]));  // as published
    for (size_t n = tree.nodes.size(); n-- > 0;) try_root(uint32_t(n));
  }

  NodeOrder order() {
    NodeOrder out;
    out.nodes.reserve(tree_.nodes.size());
    std::vector<uint32_t> roots{0};
    while (!roots.empty()) {
      const uint32_t root = roots.back();
      roots.pop_back();
      out.first.push_back(uint32_t(out.nodes.size()));
      begin(root);
      for (uint32_t i = 0; i < size_[root]; ++i) out.nodes.push_back(grow());
      std::sort_heap(cut_.begin(), cut_.end());
      for (const Open& open : cut_) roots.push_back(open.node);  // The one with the largest gain comes first.
      roots.insert(roots.end(), left_out_.rbegin(), left_out_.rend());
    }
    return out;
  }

 private:
  static constexpr uint32_t kNone = ~0u;
  static constexpr uint32_t kLeast = kLeafBytes;  // bytes of the smallest node

  // Names a node below the treelet that might be taken next.
  struct Open {
    double gain;
    uint32_t node;
    bool operator<(const Open& other) const {  // Of equal gains, the node with the lower number comes first.
      return gain != other.gain ? gain < other.gain : node > other.node;
    }
  };

  double area(uint32_t n) const { return half_area(tree_.nodes[n].bounds) + extra_; }

  void begin(uint32_t root) {
    cut_.clear();
    left_out_.clear();
    room_ = most_bytes_;
    open(root);
  }
  void open(uint32_t n) {
    cut_.push_back({area(n) / double(std::min<uint64_t>(below_[n], most_bytes_)), n});
    std::push_heap(cut_.begin(), cut_.end());
  }
  // Takes the next node that fits. Returns kNone when none does.
  uint32_t grow() {
    while (!cut_.empty() && room_ >= kLeast) {
      std::pop_heap(cut_.begin(), cut_.end());
      const uint32_t n = cut_.back().node;
      cut_.pop_back();
      const BuildTree::Node& node = tree_.nodes[n];
      const uint32_t bytes = bytes_of(node, node_bytes_);
      const bool is_root = room_ == most_bytes_;  // The root is taken, however large it is.
      if (bytes > room_ && !is_root) {
        left_out_.push_back(n);
        continue;
      }
      room_ -= std::min(bytes, room_);
      if (node.kind == NodeKind::Internal)
        for (const uint32_t child : children_of(tree_, node)) open(child);
      return n;
    }
    return kNone;
  }
  void try_root(uint32_t root) {
    begin(root);
    double open_cost = 0;  // of the treelets below this one
    cost_[root] = std::numeric_limits<double>::infinity();
    size_[root] = 1;
    const double own = area(root);
    uint32_t taken = 0;
    for (uint32_t n; (n = grow()) != kNone;) {
      ++taken;
      if (n != root) open_cost -= cost_[n];
      if (tree_.nodes[n].kind == NodeKind::Internal)
        for (const uint32_t child : children_of(tree_, tree_.nodes[n])) open_cost += cost_[child];
      if (own + open_cost >= cost_[root]) continue;
      cost_[root] = own + open_cost;
      size_[root] = taken;
    }
  }

  const BuildTree& tree_;
  const uint32_t node_bytes_, most_bytes_;
  std::vector<uint64_t> below_;  // of each node: bytes of its subtree, with itself
  std::vector<double> cost_;     // of its subtree, as the root of a treelet
  std::vector<uint32_t> size_;   // of the treelet below it: nodes
  double extra_ = 0;             // added to each area
  // The treelet that grows at the moment:
  std::vector<Open> cut_;           // a heap: the nodes below it
  std::vector<uint32_t> left_out_;  // those of them that are too large for its room
  uint32_t room_ = 0;               // bytes
};

class TreeletCost final : public TreeLayout {
 public:
  static constexpr std::string_view kName = "treelet_cost";
  static constexpr std::string_view kDoc =
      "Treelets are cut so that a ray is expected to enter few of them (HPG 2010).";
  struct Params {
    uint32_t bytes = 512;  // as treelet_breadth_first has it; the paper's own treelets are of cache size
    static ParamList params() {
      return {param(&Params::bytes, "bytes", "byte",
                    "Largest size of a treelet. A node that is larger is a treelet by itself.", 64, 65536)};
    }
  };
  TreeletCost(const Params& params, Context) : params_(params) {}

  bool forms_treelets() const override { return true; }
  NodeOrder order(const BuildTree& tree, uint32_t node_bytes) const override {
    return Cutter(tree, node_bytes, params_.bytes).order();
  }

 private:
  const Params params_;
};

const Register<TreeLayout, TreeletCost> registered;

}  // namespace
}  // namespace glint::rt
