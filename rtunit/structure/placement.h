// Gives the nodes and leaves of a tree their places in a structure's bytes, for all node formats.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/parallel_ranges.h"
#include "memsys/host_block.h"
#include "rtunit/node_format.h"

namespace glint::rt {

// Calls place(child) for every node but the root, in the order that is given, but with siblings together.
template <class Place>
void in_order(const BuildTree& tree, const NodeOrder& order, Place place) {
  const auto count = uint32_t(tree.nodes.size());
  if (order.nodes.empty()) {
    for (uint32_t n = 1; n < count; ++n) place(n);
    return;
  }
  std::vector<uint32_t> parent(count);
  for (uint32_t n = 0; n < count; ++n)
    if (tree.nodes[n].kind == NodeKind::Internal)
      for (const uint32_t child : children_of(tree, tree.nodes[n])) parent[child] = n;
  std::vector<bool> is_placed(count);  // of a node: its children are
  for (const uint32_t n : order.nodes) {
    if (n == 0 || is_placed[parent[n]]) continue;
    is_placed[parent[n]] = true;
    for (const uint32_t child : children_of(tree, tree.nodes[parent[n]])) place(child);
  }
}

// Places nodes one behind the other. The children of a node follow each other without gaps, and leaves lie
// among internal nodes.
inline Placement mixed_placement(const BuildTree& tree, const NodeOrder& order, uint32_t node_bytes) {
  Placement out{mem::HostArray<uint32_t>(tree.nodes.size()), sizeof(StructureHeader) + node_bytes};
  out.block[0] = kRootBlock;
  in_order(tree, order, [&](uint32_t child) {
    out.block[child] = uint32_t(out.bytes / kBlockBytes);
    out.bytes += bytes_of(tree.nodes[child], node_bytes);
  });
  return out;
}

// Places internal nodes one behind the other; those behind the root begin at a multiple of `alignment`. The
// leaves lie behind them at multiples of their own 64 bytes. Internal children of a node follow each other
// without gaps, and so do its leaves.
inline Placement split_placement(const BuildTree& tree, const NodeOrder& order, uint32_t node_bytes,
                                 uint32_t alignment = kBlockBytes) {
  Placement out{mem::HostArray<uint32_t>(tree.nodes.size()), 0};
  out.block[0] = kRootBlock;
  uint64_t nodes = (sizeof(StructureHeader) + node_bytes + alignment - 1) / alignment * alignment, leaves = 0;
  in_order(tree, order, [&](uint32_t child) {
    uint64_t& end = tree.nodes[child].kind == NodeKind::Internal ? nodes : leaves;
    out.block[child] = uint32_t(end / kBlockBytes);
    end += bytes_of(tree.nodes[child], node_bytes);
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
mem::HostBlock encoded(const BuildTree& tree, const Placement& placement, uint32_t threads, NodeOf node_of) {
  constexpr size_t kRange = 16384;  // nodes that a thread takes at a time
  mem::HostBlock out(placement.bytes);
  parallel_ranges(tree.nodes.size(), kRange, threads, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      const BuildTree::Node& node = tree.nodes[n];
      std::byte* to = out.data() + size_t(placement.block[n]) * kBlockBytes;
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
