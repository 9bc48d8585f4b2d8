// Lets the tree builder arrange leaves and a node format write them.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/build.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <utility>

#include "base/check.h"
#include "base/diagnostics.h"
#include "base/registry.h"
#include "rtunit/structure/build_tree.h"
#include "rtunit/structure/encode.h"
#include "rtunit/structure/leaves.h"
#include "rtunit/structure/micromap_table.h"
#include "rtunit/structure/refit.h"
#include "rtunit/structure/treelet_table.h"
#include "rtunit/traversal/ray_stack.h"

namespace glint::rt {
namespace {

constexpr uint32_t kMostNeed = 0xffff;  // far above what a ray has

// Finds the depth and the worst-case stack of a tree, from the leaves up.
StructureInfo measured(const BuildTree& tree, const std::vector<uint32_t>& stack_need) {
  StructureInfo info;
  constexpr uint32_t kInstanceBlocks = leaf_bytes(NodeKind::Instance) / kBlockBytes;
  mem::HostArray<uint16_t> need(tree.nodes.size()), depth(tree.nodes.size());
  for (size_t n = tree.nodes.size(); n-- > 0;) {
    const BuildTree::Node& node = tree.nodes[n];
    // A leaf needs at least one entry, because it comes again for its second triangle.
    uint32_t most = 1, deepest = 0;
    if (node.kind != NodeKind::Internal) {
      if (node.kind == NodeKind::Instance) most = std::max(stack_need[node.leaf_block / kInstanceBlocks], 1u);
      ++info.leaves;
    } else {
      deepest = 1;
      for (uint32_t child : children_of(tree, node)) {
        most = std::max(most, node.num_children - 1u + need[child]);  // the siblings wait below it
        deepest = std::max(deepest, 1u + depth[child]);
      }
      ++info.nodes;
    }
    need[n] = uint16_t(std::min(most, kMostNeed));
    depth[n] = uint16_t(deepest);
  }
  info.depth = depth[0];
  info.stack_need = need[0];
  return info;
}

void check_size(const std::string& name, uint64_t bytes) {
  if (bytes > kMostBytes)
    throw UserError(fmt::format("'{}': {} bytes; a structure has at most {}", name, bytes, kMostBytes));
}

// A virtual address names its structure by its upper 32 bits (rtunit/treelets.h).
void check_size_with_treelets(const std::string& name, uint64_t bytes) {
  if (bytes >> mem::AddressSpace::kShift)
    throw UserError(
        fmt::format("'{}': {} bytes with its treelets; such a structure has at most 4 GiB, so choose "
                    "bvh.layout = \"depth_first\"",
                    name, bytes));
}

}  // namespace

EncodedStructure encode(const std::string& name, uint8_t level, Leaves leaves, const BuildOptions& options,
                        uint32_t threads, KeptTree* kept) {
  check_size(name, leaves.bytes.size());
  const std::unique_ptr<NodeFormat> format = options.format.make({});
  BuildTree tree;
  const std::span<BuildItem> items(leaves.items.data(), leaves.items.size());
  build_tree(items, format->width(), threads, tree);
  StructureInfo info = measured(tree, leaves.stack_need);
  if (info.stack_need > kStackEntries && items.size() > 1) {
    build_balanced_tree(items, format->width(), tree);
    info = measured(tree, leaves.stack_need);
  }
  leaves.items = {};
  if (info.stack_need > kStackEntries)
    throw UserError(fmt::format("'{}': a ray may need {} stack entries and has {}, even in a balanced tree",
                                name, info.stack_need, kStackEntries));
  info.bounds = tree.nodes[0].bounds;
  info.primitives = leaves.primitives;
  info.contents = leaves.contents;
  tree.leaf_bytes = std::move(leaves.bytes);
  format->arrange(tree, threads);
  const NodeOrder order = options.layout.make({})->order(tree, format->node_bytes());
  Placement placement = format->place(tree, order);
  check_size(name, placement.bytes);
  StructureHeader header;
  const TreeletTable treelets = describe_treelets(order, format->node_bytes(), placement.bytes);
  if (!order.first.empty()) {
    header.treelets = uint32_t(placement.bytes / kBlockBytes);
    placement.bytes += (treelets.bytes() + kBlockBytes - 1) / kBlockBytes * kBlockBytes;
    check_size_with_treelets(name, placement.bytes);
  }
  if (!leaves.micromaps.empty()) {
    header.micromaps = uint32_t(placement.bytes / kBlockBytes);
    // A unit reads them in sectors, so that the last one is whole.
    placement.bytes = (placement.bytes + leaves.micromaps.size() + kLeafBytes - 1) / kLeafBytes * kLeafBytes;
    check_size(name, placement.bytes);
    if (header.treelets) check_size_with_treelets(name, placement.bytes);
  }
  mem::HostBlock bytes = format->encode(tree, placement, threads);
  if (header.treelets)
    write_treelets(treelets, tree, order, placement, bytes.data() + size_t{header.treelets} * kBlockBytes);
  if (header.micromaps)
    std::copy(leaves.micromaps.begin(), leaves.micromaps.end(),
              bytes.data() + size_t{header.micromaps} * kBlockBytes);
  info.bytes = bytes.size();
  header.format = info.format = format->walk().format;
  header.level = level;
  header.contents = info.contents;
  header.bounds = info.bounds;
  header.num_primitives = uint32_t(info.primitives);
  header.stack_need = info.stack_need;
  header.bytes = info.bytes;
  std::memcpy(bytes.data(), &header, sizeof header);
  if (kept)
    *kept = {std::move(tree), std::move(placement), options.format, info, std::move(leaves.stack_need)};
  return {info, std::move(bytes)};
}

uint64_t most_bytes(uint8_t level, uint64_t primitives, const BuildOptions& options) {
  // Each internal node but a root with one child has two children at least.
  const uint64_t nodes = std::max<uint64_t>(primitives, 2) - 1,
                 node_bytes = options.format.make({})->node_bytes();
  // Formats let nodes begin at multiples of their size, and leaves at multiples of theirs.
  uint64_t bytes = sizeof(StructureHeader) + (nodes + 1) * node_bytes + kLeafBytes +
                   primitives * leaf_bytes(level ? NodeKind::Instance : NodeKind::Triangle);
  if (options.layout.make({})->forms_treelets())
    bytes += TreeletTable{.num_treelets = uint32_t(nodes + primitives),
                          .num_nodes = uint32_t(nodes + primitives),
                          .num_blocks = uint32_t(bytes / kBlockBytes)}
                 .bytes() +
             kBlockBytes;
  return bytes;
}

EncodedStructure encode_bottom(const std::string& name, const BottomLevel& input, const BuildOptions& options,
                               uint32_t threads, KeptTree* kept) {
  Leaves leaves = leaves_of(input, options.pair_triangles, threads);
  leaves.micromaps = take_micromaps(input, leaves);
  return encode(name, 0, std::move(leaves), options, threads, kept);
}

StructureInfo place(mem::AddressSpace& memory, const std::string& name, EncodedStructure structure) {
  StructureInfo info = structure.info;
  info.address = memory.adopt(name, std::move(structure.bytes));
  return info;
}

StructureInfo build_bottom(mem::AddressSpace& memory, const std::string& name, const BottomLevel& input,
                           const BuildOptions& options, uint32_t threads) {
  return place(memory, name, encode_bottom(name, input, options, threads));
}

}  // namespace glint::rt
