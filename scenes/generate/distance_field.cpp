// Computes the distances of solids (negative inside), and turns their surfaces into triangles.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/distance_field.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/parallel_ranges.h"

namespace glint::scenes {
namespace {

// Lattice points along a block. A coarse block that may have a part of the surface is cut into middle ones,
// and these into fine ones.
constexpr int kCoarse = 16, kMiddle = 4, kFine = 2;
constexpr float kSlope = 1.5f;  // the steepest change that a field may have (see surface_of)
constexpr uint32_t kNone = ~0u;

float lattice_value(int x, int y, int z) {
  uint32_t h = uint32_t(x) * 0x8da6b343u ^ uint32_t(y) * 0xd8163841u ^ uint32_t(z) * 0xcb1ab31fu;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return float((h ^ h >> 15) & 0xffffff) / 8388608.0f - 1;
}

class SurfaceNets {
 public:
  SurfaceNets(const DistanceField& field, const Bounds& box, float cell, int32_t material)
      : field_(field), origin_(box.lower), cell_(cell), material_(material) {
    for (size_t axis = 0; axis < 3; ++axis)
      points_[axis] = (int((box.upper[axis] - box.lower[axis]) / cell) / kCoarse + 1) * kCoarse;
    values_.resize(size_t(points_[0]) * size_t(points_[1]) * size_t(points_[2]));
    words_ = (size_t(points_[0] / kFine) + 63) / 64;
    near_.resize(words_ * size_t(points_[1] / kFine) * size_t(points_[2] / kFine));
  }

  Model run(uint32_t threads) {
    const auto slabs = size_t(points_[2] / kCoarse);
    parallel_ranges(slabs, 1, threads, [&](size_t slab, size_t) { sample_slab(int(slab) * kCoarse); });
    // A cell whose vertex is not set in its turn touches no crossed edge, and nobody asks for its vertex.
    std::array<std::vector<uint32_t>, 2> slices;
    for (auto& slice : slices) slice.assign(size_t(points_[0]) * size_t(points_[1]), kNone);
    for (int z = 0; z + 1 < points_[2]; ++z) {
      each_near(z, [&](int x, int y) { slices[1][slot(x, y)] = cell_vertex(x, y, z); });
      if (z > 0) each_near(z, [&](int x, int y) { add_faces(slices[0], slices[1], x, y, z); });
      std::swap(slices[0], slices[1]);
    }
    compute_smooth_normals(model_);
    return std::move(model_);
  }

 private:
  size_t slot(int x, int y) const { return size_t(y) * size_t(points_[0]) + size_t(x); }
  float& value(int x, int y, int z) {
    return values_[size_t(z) * size_t(points_[0]) * size_t(points_[1]) + slot(x, y)];
  }
  Vec3 point(float x, float y, float z) const { return origin_ + Vec3{x, y, z} * cell_; }

  size_t near_row(int y, int z) const {
    return (size_t(z / kFine) * size_t(points_[1] / kFine) + size_t(y / kFine)) * words_;
  }
  // Calls visit(x, y) for the points of plane z, in order of y and x, that lie in fine blocks near the
  // surface and are the lowest corners of cells.
  template <class Visit>
  void each_near(int z, Visit&& visit) const {
    for (int y = 0; y + 1 < points_[1]; ++y)
      for (size_t word = 0; word < words_; ++word)
        for (uint64_t rest = near_[near_row(y, z) + word]; rest; rest &= rest - 1) {
          const int begin = (int(word) * 64 + std::countr_zero(rest)) * kFine;
          for (int x = begin; x < begin + kFine && x + 1 < points_[0]; ++x) visit(x, y);
        }
  }

  void sample_slab(int z) {
    for (int y = 0; y < points_[1]; y += kCoarse)
      for (int x = 0; x < points_[0]; x += kCoarse) sample_block(x, y, z, kCoarse);
  }

  // Samples the points of a block. Where the surface is far, they all get the value of the block's middle,
  // which has their sign.
  void sample_block(int x0, int y0, int z0, int size) {
    // The 1 makes the cells between this block's last points and the next block's first points count for
    // both.
    const float reach = 0.8660254f * float(size + 1);  // half the block's diagonal, in cells
    const float half = 0.5f * float(size - 1);
    const float middle = field_(point(float(x0) + half, float(y0) + half, float(z0) + half));
    if (std::abs(middle) > kSlope * reach * cell_)
      return each_in_block(x0, y0, z0, size, 1, [&](int x, int y, int z) { value(x, y, z) = middle; });
    if (size > kFine) {
      const int part = size == kCoarse ? kMiddle : kFine;
      return each_in_block(x0, y0, z0, size, part, [&](int x, int y, int z) { sample_block(x, y, z, part); });
    }
    near_[near_row(y0, z0) + size_t(x0 / kFine / 64)] |= uint64_t{1} << x0 / kFine % 64;
    each_in_block(x0, y0, z0, size, 1,
                  [&](int x, int y, int z) { value(x, y, z) = field_(point(float(x), float(y), float(z))); });
  }
  template <class Visit>
  static void each_in_block(int x0, int y0, int z0, int size, int step, const Visit& visit) {
    for (int z = z0; z < z0 + size; z += step)
      for (int y = y0; y < y0 + size; y += step)
        for (int x = x0; x < x0 + size; x += step) visit(x, y, z);
  }

  // Returns the vertex of a cell, which is the mean of the crossings of its twelve edges. Returns kNone when
  // the surface does not cross the cell.
  uint32_t cell_vertex(int x, int y, int z) {
    float v[8];
    int inside = 0;
    for (int k = 0; k < 8; ++k) {
      v[k] = value(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
      inside += v[k] < 0;
    }
    if (inside == 0 || inside == 8) return kNone;
    Vec3 sum{};
    int crossings = 0;
    for (int a = 0; a < 8; ++a)
      for (int bit = 1; bit < 8; bit <<= 1) {
        const int b = a | bit;
        if (a == b || (v[a] < 0) == (v[b] < 0)) continue;
        const float t = v[a] / (v[a] - v[b]);
        sum = sum + Vec3{float(a & 1) + (bit == 1 ? t : 0), float(a >> 1 & 1) + (bit == 2 ? t : 0),
                         float(a >> 2) + (bit == 4 ? t : 0)};
        ++crossings;
      }
    const Vec3 mean = sum * (1 / float(crossings));
    return add_vertex(model_, point(float(x) + mean[0], float(y) + mean[1], float(z) + mean[2]), {},
                      material_);
  }

  // Adds the faces of the lattice edges that leave a point along x, y and z. `below` and `above` are the
  // vertices of the cells below and above plane z.
  void add_faces(const std::vector<uint32_t>& below, const std::vector<uint32_t>& above, int x, int y,
                 int z) {
    if (x == 0 || y == 0) return;
    const bool here = value(x, y, z) < 0;
    if (here != (value(x + 1, y, z) < 0))
      add_quad(below[slot(x, y - 1)], below[slot(x, y)], above[slot(x, y)], above[slot(x, y - 1)], !here);
    if (here != (value(x, y + 1, z) < 0))
      add_quad(below[slot(x - 1, y)], below[slot(x, y)], above[slot(x, y)], above[slot(x - 1, y)], here);
    if (here != (value(x, y, z + 1) < 0))
      add_quad(above[slot(x - 1, y - 1)], above[slot(x, y - 1)], above[slot(x, y)], above[slot(x - 1, y)],
               !here);
  }

  // Adds the quad of four corners in turn. It is cut along the shorter diagonal, which follows the surface
  // better.
  void add_quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d, bool flip) {
    if (flip) std::swap(b, d);
    const auto span = [this](uint32_t i, uint32_t j) {
      return length(model_.vertices[i].position - model_.vertices[j].position);
    };
    if (span(a, c) <= span(b, d)) {
      add_triangle(model_, a, b, c);
      add_triangle(model_, a, c, d);
    } else {
      add_triangle(model_, a, b, d);
      add_triangle(model_, b, c, d);
    }
  }

  const DistanceField& field_;
  Vec3 origin_;
  float cell_;
  int32_t material_;
  std::array<int, 3> points_{};
  std::vector<float> values_;
  size_t words_ = 0;            // of a row of near_
  std::vector<uint64_t> near_;  // a bit for each fine block, row by row: the surface may be in it
  Model model_;
};

}  // namespace

float ellipsoid_distance(const Vec3& p, const Vec3& center, const Vec3& radii) {
  const Vec3 q = p - center;
  const Vec3 unit = q / radii;
  const float scaled = length(unit);
  // The distance is the scaled distance over the length of its gradient.
  const float slope = length(unit / radii);
  if (slope == 0) return -std::min({radii[0], radii[1], radii[2]});
  return scaled * (scaled - 1) / slope;
}

float limb_distance(const Vec3& p, const Vec3& start, float start_radius, const Vec3& end, float end_radius) {
  const Vec3 axis = end - start, q = p - start;
  const float t = std::clamp(dot(q, axis) / dot(axis, axis), 0.0f, 1.0f);
  return length(q - axis * t) - (start_radius + (end_radius - start_radius) * t);
}

float blended_union(float a, float b, float blend) {
  const float overlap = std::max(blend - std::abs(a - b), 0.0f) / blend;
  return std::min(a, b) - overlap * overlap * blend * 0.25f;
}

float noise(const Vec3& p) {
  int base[3];
  float f[3];
  for (size_t axis = 0; axis < 3; ++axis) {
    const float floor = std::floor(p[axis]);
    base[axis] = int(floor);
    const float t = p[axis] - floor;
    f[axis] = t * t * (3 - 2 * t);
  }
  float sum = 0;
  for (int k = 0; k < 8; ++k) {
    const int dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
    const float weight = (dx ? f[0] : 1 - f[0]) * (dy ? f[1] : 1 - f[1]) * (dz ? f[2] : 1 - f[2]);
    sum += weight * lattice_value(base[0] + dx, base[1] + dy, base[2] + dz);
  }
  return sum;
}

float wave(float x) {
  const float t = x - std::floor(x), s = t * (1 - t);
  return 32 * s * s - 1;
}

Model surface_of(const DistanceField& field, const Bounds& box, float cell, int32_t material,
                 uint32_t threads) {
  return SurfaceNets(field, box, cell, material).run(threads);
}

}  // namespace glint::scenes
