// Lets the tree builder arrange leaves and a node format write them.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/build.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "base/check.h"
#include "base/diagnostics.h"
#include "base/registry.h"
#include "rtunit/structure/build_tree.h"
#include "rtunit/structure/leaves.h"
#include "rtunit/structure/micromap_table.h"
#include "rtunit/structure/treelet_table.h"
#include "rtunit/traversal/ray_stack.h"

namespace glint::rt {
namespace {

constexpr uint32_t kMostNeed = 0xffff;  // far above what a ray has

// Finds the depth and the worst-case stack of a tree, from the leaves up.
void measure(const BuildTree& tree, const std::vector<uint32_t>& stack_need, StructureInfo& info) {
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

EncodedBottom encode(const std::string& name, uint8_t level, Leaves leaves, const BuildOptions& options,
                     uint32_t threads) {
  check_size(name, leaves.bytes.size());
  const std::unique_ptr<NodeFormat> format = options.format.make({});
  BuildTree tree;
  build_tree({leaves.items.data(), leaves.items.size()}, format->width(), threads, tree);
  leaves.items = {};
  StructureInfo info;
  measure(tree, leaves.stack_need, info);
  if (info.stack_need > kStackEntries)
    throw UserError(
        fmt::format("'{}': a ray may need {} stack entries and has {}; the tree is too unbalanced", name,
                    info.stack_need, kStackEntries));
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
  return {info, std::move(bytes)};
}

// Returns the inverse of a 3x4 affine transform, computed in double and rounded once, or nothing when there
// is no inverse.
std::optional<std::array<float, 12>> inverse(const std::array<float, 12>& m) {
  const auto at = [&](int r, int c) { return double(m[size_t(4 * (r % 3) + c % 3)]); };
  double cofactor[3][3];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)  // Cyclic indices carry the sign.
      cofactor[r][c] = at(r + 1, c + 1) * at(r + 2, c + 2) - at(r + 1, c + 2) * at(r + 2, c + 1);
  const double det = at(0, 0) * cofactor[0][0] + at(0, 1) * cofactor[0][1] + at(0, 2) * cofactor[0][2];
  if (!(std::fabs(det) > 0) || !std::isfinite(det)) return {};
  std::array<float, 12> out;
  for (size_t r = 0; r < 3; ++r) {
    double translation = 0;
    for (size_t c = 0; c < 3; ++c) {
      const double x = cofactor[c][r] / det;
      out[4 * r + c] = float(x);
      translation -= x * m[4 * c + 3];
    }
    out[4 * r + 3] = float(translation);
  }
  if (!std::all_of(out.begin(), out.end(), [](float x) { return std::isfinite(x); })) return {};
  return out;
}

// Returns the world box of a transformed box. It is padded by the most that rounding the ray into object
// space may move it. Without a transform there is no pad, which could cost a whole step of a node's planes.
Bounds world_bounds(const std::array<float, 12>& m, const Bounds& box) {
  if (m == kIdentity) return box;
  constexpr double kPad = 8 * 0x1p-24;
  Bounds out;
  for (size_t r = 0; r < 3; ++r) {
    double low = m[4 * r + 3], high = low, size = std::fabs(low);
    for (size_t c = 0; c < 3; ++c) {
      const double a = double(m[4 * r + c]) * box.low[c], b = double(m[4 * r + c]) * box.high[c];
      low += std::fmin(a, b);
      high += std::fmax(a, b);
      size += std::fmax(std::fabs(a), std::fabs(b));
    }
    out.low[r] = float(low - kPad * size);
    out.high[r] = float(high + kPad * size);
  }
  return out;
}

}  // namespace

EncodedBottom encode_bottom(const std::string& name, const BottomLevel& input, const BuildOptions& options,
                            uint32_t threads) {
  Leaves leaves = leaves_of(input, options.pair_triangles, threads);
  leaves.micromaps = take_micromaps(input, leaves);
  return encode(name, 0, std::move(leaves), options, threads);
}

StructureInfo place(mem::AddressSpace& memory, const std::string& name, EncodedBottom bottom) {
  StructureInfo info = bottom.info;
  info.address = memory.adopt(name, std::move(bottom.bytes));
  return info;
}

StructureInfo build_bottom(mem::AddressSpace& memory, const std::string& name, const BottomLevel& input,
                           const BuildOptions& options) {
  return place(memory, name, encode_bottom(name, input, options));
}

std::string why_unreachable(const Instance& instance, const StructureInfo& bottom) {
  if (bottom.primitives == 0) return {};  // The instance is inactive.
  if (!inverse(instance.transform)) return "its transform cannot be inverted in floats";
  return is_finite(world_bounds(instance.transform, bottom.bounds)) ? ""
                                                                    : "its transform moves it to infinity";
}

StructureInfo build_top(mem::AddressSpace& memory, const std::string& name,
                        std::span<const Instance> instances, std::span<const StructureInfo> bottoms,
                        const BuildOptions& options) {
  const FormatId format = options.format.make({})->walk().format;
  std::vector<BuildItem> items;
  std::vector<InstanceLeaf> instance_leaves;
  Leaves leaves;
  for (size_t i = 0; i < instances.size(); ++i) {
    const Instance& instance = instances[i];
    if (instance.bottom >= bottoms.size())
      throw UserError(
          fmt::format("instance {} names bottom level {} of {}", i, instance.bottom, bottoms.size()));
    const StructureInfo& bottom = bottoms[instance.bottom];
    if (bottom.format != format)
      throw UserError(fmt::format("'{}': bottom level {} has another node format", name, instance.bottom));
    if (bottom.primitives == 0) continue;
    if (const std::string why = why_unreachable(instance, bottom); !why.empty())
      throw UserError(fmt::format("'{}': instance {}: {}", name, i, why));
    InstanceLeaf leaf;
    leaf.world_to_object = *inverse(instance.transform);
    leaf.structure = bottom.address;
    leaf.custom_index_and_mask = (instance.custom_index & 0xff'ffff) | instance.mask << 24;
    leaf.sbt_offset_and_flags = (instance.sbt_offset & 0xff'ffff) | instance.flags << 24;
    leaf.object_to_world = instance.transform;
    leaf.instance = uint32_t(i);
    leaves.contents |= bottom.contents;
    if (instance.flags & instance_flag::kForceNoOpaque) leaves.contents |= contents::kNotOpaque;
    items.emplace_back(world_bounds(instance.transform, bottom.bounds), NodeKind::Instance,
                       uint32_t(items.size() * sizeof leaf / kBlockBytes));
    instance_leaves.push_back(leaf);
    leaves.stack_need.push_back(bottom.stack_need);
  }
  leaves.primitives = items.size();
  leaves.items = mem::HostArray<BuildItem>(items.size());
  std::copy(items.begin(), items.end(), leaves.items.begin());
  leaves.bytes = mem::HostBlock(items.size() * sizeof(InstanceLeaf));
  std::copy(instance_leaves.begin(), instance_leaves.end(),
            reinterpret_cast<InstanceLeaf*>(leaves.bytes.data()));
  return place(memory, name, encode(name, 1, std::move(leaves), options, 1));
}

}  // namespace glint::rt
