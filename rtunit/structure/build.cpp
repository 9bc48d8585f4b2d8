// Turns geometry into leaves, lets the tree builder arrange them and a node format write them.
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
#include "rtunit/traversal/ray_stack.h"

namespace glint::rt {
namespace {

using Vec3 = std::array<float, 3>;
using Triangle = std::array<Vec3, 3>;

struct Leaves {
  std::vector<BuildItem> items;
  std::vector<uint32_t> stack_need;  // stack entries needed below each leaf, by item
  std::vector<std::byte> bytes;
  uint64_t primitives = 0;
  uint8_t contents = 0;  // as StructureHeader::contents
  template <class Leaf>
  void add(const Bounds& bounds, NodeKind kind, const Leaf& leaf, uint32_t need = 0) {
    const size_t at = bytes.size();
    items.push_back({bounds, kind, uint32_t(at / kBlockBytes)});
    stack_need.push_back(need);
    bytes.resize(at + sizeof leaf);
    std::memcpy(&bytes[at], &leaf, sizeof leaf);
  }
};

Bounds bounds_of(const Triangle& triangle) {
  Bounds out{triangle[0], triangle[0]};
  for (const Vec3& p : triangle) extend(out, {p, p});
  return out;
}
bool is_finite(const Bounds& b) {
  return std::all_of(b.low.begin(), b.low.end(), [](float x) { return std::isfinite(x); }) &&
         std::all_of(b.high.begin(), b.high.end(), [](float x) { return std::isfinite(x); });
}
double half_area(const Bounds& b) {
  const double x = double(b.high[0]) - b.low[0], y = double(b.high[1]) - b.low[1],
               z = double(b.high[2]) - b.low[2];
  return x * y + y * z + z * x;
}

bool has_area(const Triangle& t) {
  double a[3], b[3];
  for (size_t i = 0; i < 3; ++i) {
    a[i] = double(t[1][i]) - t[0][i];
    b[i] = double(t[2][i]) - t[0][i];
  }
  return a[1] * b[2] != a[2] * b[1] || a[2] * b[0] != a[0] * b[2] || a[0] * b[1] != a[1] * b[0];
}

Vec3 transformed(const std::array<float, 12>& m, const Vec3& p) {
  Vec3 out;
  for (size_t r = 0; r < 3; ++r)
    out[r] = ((m[4 * r] * p[0] + m[4 * r + 1] * p[1]) + m[4 * r + 2] * p[2]) + m[4 * r + 3];
  return out;
}

uint64_t num_triangles(const Geometry& g) {
  return (g.indices.empty() ? (g.positions.size() + g.stride - 12) / g.stride : g.indices.size()) / 3;
}

// Returns the corners of a triangle, or nothing when the triangle is inactive.
std::optional<Triangle> triangle_at(const Geometry& g, uint64_t index) {
  Triangle out;
  for (size_t corner = 0; corner < 3; ++corner) {
    const uint64_t vertex = g.indices.empty() ? 3 * index + corner : g.indices[3 * index + corner];
    if (vertex * g.stride + 12 > g.positions.size())
      throw UserError(fmt::format("triangle {} names vertex {}, and there are only {} bytes of vertices",
                                  index, vertex, g.positions.size()));
    std::memcpy(&out[corner], &g.positions[vertex * g.stride], 12);
    if (g.transform != kIdentity) out[corner] = transformed(g.transform, out[corner]);
    for (float x : out[corner])
      if (!std::isfinite(x)) return {};
  }
  if (!has_area(out)) return {};
  return out;
}

// Adds `second` to a leaf that holds `first` when they share two corners and the common box is no larger than
// both.
bool try_pair(const Triangle& first, const Triangle& second, TriangleLeaf& leaf) {
  Bounds both = bounds_of(first);
  extend(both, bounds_of(second));
  if (half_area(both) > half_area(bounds_of(first)) + half_area(bounds_of(second))) return false;
  uint8_t pick = 0;
  int others = 0;
  for (int corner = 0; corner < 3; ++corner) {
    const auto same = std::find(first.begin(), first.end(), second[corner]);
    if (same == first.end()) {
      ++others;
      leaf.vertex[3] = second[corner];
    }
    pick |= uint8_t((same - first.begin()) << (2 * corner));
  }
  if (others != 1) return false;
  leaf.second = pick;
  leaf.count = 2;
  return true;
}

void add_triangles(const Geometry& g, uint32_t geometry, bool pair, Leaves& leaves) {
  if (g.positions.empty()) return;
  GLINT_CHECK(g.stride >= 12, "a vertex stride of {} bytes is shorter than a position", g.stride);
  const uint64_t count = num_triangles(g);
  for (uint64_t i = 0; i < count; ++i) {
    const std::optional<Triangle> first = triangle_at(g, i);
    if (!first) continue;
    TriangleLeaf leaf{};
    std::copy(first->begin(), first->end(), leaf.vertex.begin());
    leaf.vertex[3] = (*first)[2];
    leaf.primitive = {uint32_t(i), uint32_t(i)};
    leaf.geometry = geometry;
    leaf.opaque = g.opaque;
    leaf.count = 1;
    Bounds bounds = bounds_of(*first);
    if (const auto second = pair && i + 1 < count ? triangle_at(g, i + 1) : std::nullopt;
        second && try_pair(*first, *second, leaf)) {
      leaf.primitive[1] = uint32_t(++i);
      extend(bounds, bounds_of(*second));
    }
    leaves.primitives += leaf.count;
    if (!g.opaque) leaves.contents |= contents::kNotOpaque;
    leaves.add(bounds, NodeKind::Triangle, leaf);
  }
}

void add_aabbs(const Geometry& g, uint32_t geometry, Leaves& leaves) {
  for (size_t i = 0; i < g.aabbs.size(); ++i) {
    const Bounds& box = g.aabbs[i];
    // In Vulkan a box is inactive when its first coordinate is not a number. Choice: it is also inactive when
    // any coordinate is infinite or the box is inside out.
    if (!is_finite(box) || box.low[0] > box.high[0] || box.low[1] > box.high[1] || box.low[2] > box.high[2])
      continue;
    ProceduralLeaf leaf;
    leaf.box = box;
    leaf.geometry = geometry;
    leaf.primitive = uint32_t(i);
    leaf.opaque = g.opaque;
    ++leaves.primitives;
    leaves.contents |= contents::kProcedural;
    leaves.add(box, NodeKind::Procedural, leaf);
  }
}

// Finds the depth and the worst-case stack of a tree, from the leaves up.
void measure(const BuildTree& tree, const Leaves& leaves, StructureInfo& info) {
  std::vector<uint32_t> need(tree.nodes.size()), depth(tree.nodes.size());
  std::vector<uint32_t> need_of_block(leaves.bytes.size() / kBlockBytes + 1);
  for (size_t i = 0; i < leaves.items.size(); ++i)
    need_of_block[leaves.items[i].leaf_block] = leaves.stack_need[i];
  for (size_t n = tree.nodes.size(); n-- > 0;) {
    const BuildTree::Node& node = tree.nodes[n];
    if (node.kind != NodeKind::Internal) {
      // A leaf needs at least one entry, because it comes again for its second triangle.
      need[n] = std::max(need_of_block[node.leaf_block], 1u);
      ++info.leaves;
      continue;
    }
    ++info.nodes;
    depth[n] = 1;
    need[n] = 1;
    for (uint32_t i = 0; i < node.num_children; ++i) {
      const uint32_t child = tree.children[node.first_child + i];
      need[n] = std::max(need[n], node.num_children - 1 + need[child]);  // the siblings wait below it
      depth[n] = std::max(depth[n], 1 + depth[child]);
    }
  }
  info.depth = depth[0];
  info.stack_need = need[0];
}

EncodedBottom encode(const std::string& name, uint8_t level, Leaves& leaves, const BuildOptions& options) {
  const std::unique_ptr<NodeFormat> format = options.format.make({});
  BuildTree tree;
  build_tree(leaves.items, format->width(), tree);
  StructureInfo info;
  measure(tree, leaves, info);
  if (info.stack_need > kStackEntries)
    throw UserError(
        fmt::format("'{}': a ray may need {} stack entries and has {}; the tree is too unbalanced", name,
                    info.stack_need, kStackEntries));
  info.bounds = tree.nodes[0].bounds;
  info.primitives = leaves.primitives;
  info.contents = leaves.contents;
  tree.leaf_bytes = std::move(leaves.bytes);
  std::vector<std::byte> bytes = format->encode(tree);
  info.bytes = bytes.size();
  info.format = format->id();
  if (info.bytes > kMostBytes)
    throw UserError(fmt::format("'{}': {} bytes; a structure has at most {}", name, info.bytes, kMostBytes));
  StructureHeader header;
  header.format = uint8_t(format->id());
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

std::unique_ptr<NodeFormat> make_format(std::string_view name) {
  return Registry<NodeFormat>::instance().entry(name).make_default({});
}
std::unique_ptr<NodeFormat> make_format(FormatId id) {
  for (const std::string& name : Registry<NodeFormat>::names())
    if (auto format = make_format(name); format->id() == id) return format;
  return nullptr;
}

EncodedBottom encode_bottom(const std::string& name, const BottomLevel& input, const BuildOptions& options) {
  Leaves leaves;
  for (size_t g = 0; g < input.geometries.size(); ++g) {
    const Geometry& geometry = input.geometries[g];
    if (geometry.aabbs.empty())
      add_triangles(geometry, uint32_t(g), options.pair_triangles, leaves);
    else
      add_aabbs(geometry, uint32_t(g), leaves);
  }
  return encode(name, 0, leaves, options);
}

StructureInfo place(mem::AddressSpace& memory, const std::string& name, const EncodedBottom& bottom) {
  StructureInfo info = bottom.info;
  info.address = memory.allocate(name, info.bytes);
  memory.write(info.address, bottom.bytes.data(), info.bytes);
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
  const FormatId format = options.format.make({})->id();
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
    ++leaves.primitives;
    leaves.contents |= bottom.contents;
    if (instance.flags & instance_flag::kForceNoOpaque) leaves.contents |= contents::kNotOpaque;
    leaves.add(world_bounds(instance.transform, bottom.bounds), NodeKind::Instance, leaf, bottom.stack_need);
  }
  return place(memory, name, encode(name, 1, leaves, options));
}

}  // namespace glint::rt
