// Decides where the nodes and leaves of a tree lie in a structure's bytes, for all encodings.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "base/parallel_ranges.h"
#include "memsys/host_block.h"
#include "rtunit/node_format.h"

namespace glint::rt {

struct Layout {
  mem::HostArray<uint32_t> block;  // block of each node of the tree, counted from the header
  uint64_t bytes = 0;              // bytes of the structure
};

inline std::span<const uint32_t> children_of(const BuildTree& tree, const BuildTree::Node& node) {
  return {tree.children.data() + node.first_child, node.num_children};
}

// Calls visit(child) for every child of every internal node. Siblings come together; the subtree of the first
// comes next.
template <class Visit>
void depth_first(const BuildTree& tree, Visit visit) {
  std::vector<uint32_t> stack{0}, inner;
  while (!stack.empty()) {
    const BuildTree::Node& node = tree.nodes[stack.back()];
    stack.pop_back();
    inner.clear();
    for (uint32_t child : children_of(tree, node)) {
      visit(child);
      if (tree.nodes[child].kind == NodeKind::Internal) inner.push_back(child);
    }
    stack.insert(stack.end(), inner.rbegin(), inner.rend());
  }
}

// Lays nodes out depth first. The children of a node follow each other without gaps, and leaves lie among
// internal nodes.
inline Layout mixed_layout(const BuildTree& tree, uint32_t node_bytes) {
  Layout out{mem::HostArray<uint32_t>(tree.nodes.size()), sizeof(StructureHeader) + node_bytes};
  out.block[0] = kRootBlock;
  depth_first(tree, [&](uint32_t child) {
    const NodeKind kind = tree.nodes[child].kind;
    out.block[child] = uint32_t(out.bytes / kBlockBytes);
    out.bytes += kind == NodeKind::Internal ? node_bytes : leaf_bytes(kind);
  });
  return out;
}

// Lays internal nodes out depth first and packed. The leaves lie behind them at multiples of their own 64
// bytes. Internal children of a node follow each other without gaps, and so do its leaves.
inline Layout split_layout(const BuildTree& tree, uint32_t node_bytes) {
  Layout out{mem::HostArray<uint32_t>(tree.nodes.size()), 0};
  out.block[0] = kRootBlock;
  uint64_t nodes = sizeof(StructureHeader) + node_bytes, leaves = 0;
  depth_first(tree, [&](uint32_t child) {
    const NodeKind kind = tree.nodes[child].kind;
    uint64_t& end = kind == NodeKind::Internal ? nodes : leaves;
    out.block[child] = uint32_t(end / kBlockBytes);
    end += kind == NodeKind::Internal ? node_bytes : leaf_bytes(kind);
  });
  const uint64_t first_leaf = (nodes + kLeafBytes - 1) / kLeafBytes * kLeafBytes;
  for (size_t n = 0; n < tree.nodes.size(); ++n)
    if (tree.nodes[n].kind != NodeKind::Internal) out.block[n] += uint32_t(first_leaf / kBlockBytes);
  out.bytes = first_leaf + leaves;
  return out;
}

// Returns the structure's bytes with all leaves, and what node_of(node) makes of each internal node. The
// header is zero. Calls of node_of() come from up to `threads` threads.
template <class NodeOf>
mem::HostBlock encoded(const BuildTree& tree, const Layout& layout, uint32_t threads, NodeOf node_of) {
  constexpr size_t kRange = 16384;  // nodes that a thread takes at a time
  mem::HostBlock out(layout.bytes);
  parallel_ranges(tree.nodes.size(), kRange, threads, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      const BuildTree::Node& node = tree.nodes[n];
      std::byte* to = out.data() + size_t(layout.block[n]) * kBlockBytes;
      if (node.kind == NodeKind::Internal) {
        const auto made = node_of(node);
        std::memcpy(to, &made, sizeof made);
      } else {
        std::memcpy(to, tree.leaf_bytes.data() + size_t(node.leaf_block) * kBlockBytes,
                    leaf_bytes(node.kind));
      }
    }
  });
  return out;
}

}  // namespace glint::rt
