// Turns instances into the leaves of a top level.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "base/diagnostics.h"
#include "rtunit/structure/build.h"
#include "rtunit/structure/encode.h"
#include "rtunit/structure/input_primitives.h"
#include "rtunit/structure/top_leaves.h"

namespace glint::rt {
namespace {

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

std::string why_unreachable(const Instance& instance, const StructureInfo& bottom) {
  if (bottom.primitives == 0) return {};  // The instance is inactive.
  if (!inverse(instance.transform)) return "its transform cannot be inverted in floats";
  return is_finite(world_bounds(instance.transform, bottom.bounds)) ? ""
                                                                    : "its transform moves it to infinity";
}

Leaves top_leaves(const std::string& name, std::span<const Instance> instances,
                  std::span<const StructureInfo> bottoms, FormatId format, std::vector<std::string>* notes) {
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
    if (const std::string why = why_unreachable(instance, bottom); !why.empty()) {
      const std::string note = fmt::format("'{}': instance {}: {}", name, i, why);
      if (!notes) throw UserError(note);
      notes->push_back(note);
      continue;
    }
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
  return leaves;
}

EncodedStructure encode_top(const std::string& name, std::span<const Instance> instances,
                            std::span<const StructureInfo> bottoms, const BuildOptions& options,
                            std::vector<std::string>* notes, KeptTree* kept) {
  const FormatId format = options.format.make({})->walk().format;
  return encode(name, 1, top_leaves(name, instances, bottoms, format, notes), options, 1, kept);
}

StructureInfo build_top(mem::AddressSpace& memory, const std::string& name,
                        std::span<const Instance> instances, std::span<const StructureInfo> bottoms,
                        const BuildOptions& options) {
  return place(memory, name, encode_top(name, instances, bottoms, options));
}

}  // namespace glint::rt
