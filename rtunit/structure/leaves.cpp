// Decides which primitives share a leaf, and writes the leaves.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/leaves.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include "base/check.h"
#include "base/parallel_ranges.h"
#include "rtunit/structure/input_primitives.h"

namespace glint::rt {
namespace {

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

// Finds and writes the leaves of one geometry. A triangle shares a leaf with the next one where it may and
// where it is not taken itself, so the leaves follow from the first triangle on. What two neighbours may do
// is found for all of them first, on all threads.
class GeometryLeaves {
 public:
  GeometryLeaves(const Geometry& geometry, uint32_t number, bool pair, uint32_t threads)
      : geometry_(geometry), number_(number) {
    if (geometry.aabbs.empty()) {
      if (geometry.positions.empty()) return;
      GLINT_CHECK(geometry.stride >= 12, "a vertex stride of {} bytes is shorter than a position",
                  geometry.stride);
      roles_ = mem::HostArray<Role>(num_triangles(geometry));
      for_ranges(threads, [&](size_t begin, size_t end) { look_at_triangles(begin, end, pair); });
    } else {
      roles_ = mem::HostArray<Role>(geometry.aabbs.size());
      for_ranges(threads, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
          roles_[i] = is_active(geometry_.aabbs[i]) ? Role::Single : Role::None;
      });
    }
    assign();
  }

  uint64_t num_leaves() const { return num_leaves_; }
  uint64_t num_primitives() const { return num_primitives_; }
  uint8_t contents() const {
    if (num_leaves_ == 0) return 0;
    if (!geometry_.aabbs.empty()) return contents::kProcedural;
    return geometry_.opaque && !geometry_.micromaps ? 0 : contents::kNotOpaque;
  }

  // Writes the leaves from number `first` on.
  void write(uint64_t first, uint32_t threads, Leaves& out) const {
    for_ranges(threads, [&](size_t begin, size_t end) {
      uint64_t leaf = first + first_leaf_[begin / kRange];
      for (size_t i = begin; i < end; ++i) {
        if (roles_[i] != Role::Single && roles_[i] != Role::First) continue;
        geometry_.aabbs.empty() ? write_triangles(i, leaf, out) : write_aabb(i, leaf, out);
        ++leaf;
      }
    });
  }

 private:
  static constexpr size_t kRange = 65536;  // primitives that a thread takes at a time

  // Says what a primitive is. Before assign(), First is a triangle that may share a leaf with the next one.
  enum class Role : uint8_t { None, Single, First, Second };

  template <class Work>
  void for_ranges(uint32_t threads, const Work& work) const {
    parallel_ranges(roles_.size(), kRange, threads, work);
  }

  void look_at_triangles(size_t begin, size_t end, bool pair) {
    std::optional<Triangle> first = triangle_at(geometry_, begin);
    for (size_t i = begin; i < end; ++i) {
      std::optional<Triangle> second;
      if (i + 1 < (pair ? roles_.size() : end)) second = triangle_at(geometry_, i + 1);
      TriangleLeaf unused;
      if (first) roles_[i] = pair && second && try_pair(*first, *second, unused) ? Role::First : Role::Single;
      first = second;
    }
  }

  void assign() {
    for (size_t i = 0; i < roles_.size(); ++i) {
      if (i % kRange == 0) first_leaf_.push_back(num_leaves_);
      const bool is_second = i > 0 && roles_[i - 1] == Role::First;
      if (is_second) roles_[i] = Role::Second;
      num_primitives_ += roles_[i] != Role::None;
      num_leaves_ += roles_[i] == Role::Single || roles_[i] == Role::First;
    }
  }

  template <class Leaf>
  static void put(uint64_t number, const Bounds& bounds, NodeKind kind, const Leaf& leaf, Leaves& out) {
    static_assert(sizeof leaf == kLeafBytes);
    out.items[number] = {bounds, kind, uint32_t(number * (kLeafBytes / kBlockBytes))};
    std::memcpy(out.bytes.data() + number * kLeafBytes, &leaf, sizeof leaf);
  }

  void write_triangles(size_t i, uint64_t number, Leaves& out) const {
    const Triangle first = *triangle_at(geometry_, i);
    TriangleLeaf leaf{};
    std::copy(first.begin(), first.end(), leaf.vertex.begin());
    leaf.vertex[3] = first[2];
    leaf.primitive = {uint32_t(i), uint32_t(i)};
    leaf.geometry = number_;
    leaf.opaque = geometry_.opaque;
    leaf.count = 1;
    Bounds bounds = bounds_of(first);
    if (roles_[i] == Role::First) {
      const Triangle second = *triangle_at(geometry_, i + 1);
      try_pair(first, second, leaf);
      leaf.primitive[1] = uint32_t(i + 1);
      extend(bounds, bounds_of(second));
    }
    put(number, bounds, NodeKind::Triangle, leaf, out);
  }

  void write_aabb(size_t i, uint64_t number, Leaves& out) const {
    ProceduralLeaf leaf;
    leaf.box = geometry_.aabbs[i];
    leaf.geometry = number_;
    leaf.primitive = uint32_t(i);
    leaf.opaque = geometry_.opaque;
    put(number, leaf.box, NodeKind::Procedural, leaf, out);
  }

  const Geometry& geometry_;
  const uint32_t number_;
  mem::HostArray<Role> roles_;
  std::vector<uint64_t> first_leaf_;  // of each range: the number of leaves before it
  uint64_t num_leaves_ = 0, num_primitives_ = 0;
};

}  // namespace

Leaves leaves_of(const BottomLevel& input, bool pair_triangles, uint32_t threads) {
  std::vector<GeometryLeaves> geometries;
  Leaves out;
  uint64_t leaves = 0;
  for (size_t g = 0; g < input.geometries.size(); ++g) {
    geometries.emplace_back(input.geometries[g], uint32_t(g), pair_triangles, threads);
    leaves += geometries.back().num_leaves();
    out.primitives += geometries.back().num_primitives();
    out.contents |= geometries.back().contents();
  }
  out.items = mem::HostArray<BuildItem>(leaves);
  out.bytes = mem::HostBlock(leaves * kLeafBytes);
  uint64_t first = 0;
  for (const GeometryLeaves& geometry : geometries) {
    geometry.write(first, threads, out);
    first += geometry.num_leaves();
  }
  return out;
}

}  // namespace glint::rt
