// Declares the interface of the policies that choose the order in which a tree's nodes lie in memory, and
// which of them form a treelet.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "base/registry.h"
#include "rtunit/structure/tree.h"

namespace glint::rt {

// Lists the nodes of a tree in the order in which they are to lie in memory. A node format may need siblings
// together; these then lie where the first of them comes.
struct NodeOrder {
  std::vector<uint32_t> nodes;  // each node once; empty: as the tree numbers them, depth first
  // Of each treelet: the index in `nodes` of its first node. Empty: there are no treelets.
  std::vector<uint32_t> first;
};

// Contract (tests/contract/rt_tree_layout_test.cpp):
//  - A treelet is a part of the tree that hangs together. Its first node is its root, and the parent of every
//    other one comes before it in the same treelet.
//  - Either every node belongs to one treelet, or none does (forms_treelets()).
//  - The order depends on the arguments alone.
class TreeLayout {
 public:
  static constexpr PolicyKind kKind{"bvh.layout", "rtunit/layouts"};
  struct Context {};
  virtual ~TreeLayout() = default;
  virtual bool forms_treelets() const { return false; }
  // Returns the order of the nodes. An internal node has `node_bytes`, a leaf leaf_bytes() of its kind.
  virtual NodeOrder order(const BuildTree& tree, uint32_t node_bytes) const = 0;
};

// Returns the bytes of a node of a tree.
inline uint32_t bytes_of(const BuildTree::Node& node, uint32_t node_bytes) {
  return node.kind == NodeKind::Internal ? node_bytes : leaf_bytes(node.kind);
}

}  // namespace glint::rt
