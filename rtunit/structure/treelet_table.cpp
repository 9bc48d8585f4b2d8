// Lists the nodes of each treelet, and the treelet of each block.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/treelet_table.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace glint::rt {

TreeletTable describe_treelets(const NodeOrder& order, uint32_t node_bytes, uint64_t bytes) {
  return {uint32_t(order.first.size()), uint32_t(order.nodes.size()), uint32_t(bytes / kBlockBytes),
          node_bytes};
}

void write_treelets(const TreeletTable& table, const BuildTree& tree, const NodeOrder& order,
                    const Placement& placement, std::byte* to) {
  std::vector<uint32_t> words(order.first);
  words.push_back(table.num_nodes);
  const size_t nodes = words.size(), blocks = nodes + table.num_nodes;
  words.resize(blocks + table.num_blocks, TreeletTable::kNone);
  uint32_t treelet = 0;
  for (uint32_t i = 0; i < table.num_nodes; ++i) {
    while (i >= words[treelet + 1]) ++treelet;
    const uint32_t n = order.nodes[i];
    const BuildTree::Node& node = tree.nodes[n];
    words[nodes + i] = node_ref(placement.block[n], node.kind);
    std::fill_n(words.begin() + ptrdiff_t(blocks + placement.block[n]),
                bytes_of(node, table.node_bytes) / kBlockBytes, treelet);
  }
  std::memcpy(to, &table, sizeof table);
  std::memcpy(to + sizeof table, words.data(), words.size() * sizeof(uint32_t));
}

}  // namespace glint::rt
