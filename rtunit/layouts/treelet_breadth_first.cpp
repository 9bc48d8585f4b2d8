// Implements the tree layout `treelet_breadth_first`: treelets take the nodes below their root level by level
// until one does not fit (Chou, Nowicki, Aamodt, MICRO 2023, as their released code forms treelets).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/registry.h"
#include "rtunit/tree_layout.h"

namespace glint::rt {
namespace {

// Model: treelets end at instances, because a structure is encoded by itself and many instances may share it.
// The released code lets them go on into the bottom level. Choice: the treelets that a treelet leaves open
// follow it, depth first.
class TreeletBreadthFirst final : public TreeLayout {
 public:
  static constexpr std::string_view kName = "treelet_breadth_first";
  static constexpr std::string_view kDoc =
      "A treelet takes the nodes below its root level by level until one does not fit (MICRO 2023).";
  struct Params {
    uint32_t bytes = 512;  // the published size
    static ParamList params() {
      return {param(&Params::bytes, "bytes", "byte",
                    "Largest size of a treelet. A node that is larger is a treelet by itself.", 64,
                    1u << 20)};
    }
  };
  TreeletBreadthFirst(const Params& params, Context) : params_(params) {}

  bool forms_treelets() const override { return true; }

  NodeOrder order(const BuildTree& tree, uint32_t node_bytes) const override {
    NodeOrder out;
    out.nodes.reserve(tree.nodes.size());
    std::vector<uint32_t> roots{0}, level_order;
    while (!roots.empty()) {
      level_order.assign(1, roots.back());
      roots.pop_back();
      out.first.push_back(uint32_t(out.nodes.size()));
      uint32_t used = 0;
      size_t at = 0;
      for (; at < level_order.size(); ++at) {
        const BuildTree::Node& node = tree.nodes[level_order[at]];
        used += bytes_of(node, node_bytes);
        if (at > 0 && used > params_.bytes) break;
        out.nodes.push_back(level_order[at]);
        if (node.kind != NodeKind::Internal) continue;
        const auto children = children_of(tree, node);
        level_order.insert(level_order.end(), children.begin(), children.end());
      }
      roots.insert(roots.end(), level_order.rbegin(), level_order.rend() - ptrdiff_t(at));
    }
    return out;
  }

 private:
  const Params params_;
};

const Register<TreeLayout, TreeletBreadthFirst> registered;

}  // namespace
}  // namespace glint::rt
