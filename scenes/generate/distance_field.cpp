// Computes the distances of solids (negative inside), and turns their surfaces into triangles.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace glint::scenes {
namespace {

constexpr int kBlock = 4;       // lattice points along a block that is skipped or sampled as a whole
constexpr int kCoarse = 16;     // lattice points along a larger block, which is tried first
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
    near_.resize(values_.size() / (kBlock * kBlock * kBlock));
  }

  Model run() {
    sample();
    std::array<std::vector<uint32_t>, 2> slices;
    slices[0].resize(size_t(points_[0]) * size_t(points_[1]));
    for (int z = 0; z + 1 < points_[2]; ++z) {
      slices[1].assign(slices[0].size(), kNone);
      for (int y = 0; y + 1 < points_[1]; ++y)
        for_near_points(0, y, z, [&](int x) { slices[1][slot(x, y)] = cell_vertex(x, y, z); });
      if (z > 0) add_faces(slices[0], slices[1], z);
      std::swap(slices[0], slices[1]);
    }
    compute_smooth_normals(model_);
    return std::move(model_);
  }

 private:
  size_t slot(int x, int y) const { return size_t(y) * size_t(points_[0]) + size_t(x); }
  float value(int x, int y, int z) const {
    return values_[size_t(z) * size_t(points_[0]) * size_t(points_[1]) + slot(x, y)];
  }
  Vec3 point(float x, float y, float z) const { return origin_ + Vec3{x, y, z} * cell_; }

  size_t block(int x, int y, int z) const {
    return (size_t(z / kBlock) * size_t(points_[1] / kBlock) + size_t(y / kBlock)) *
               size_t(points_[0] / kBlock) +
           size_t(x / kBlock);
  }
  // Calls `visit` with each x of a row, from `first` to the last but one, whose point lies in a block that is
  // near the surface. The other points have the sign of all points next to them.
  template <class Visit>
  void for_near_points(int first, int y, int z, const Visit& visit) const {
    for (int x0 = 0; x0 < points_[0]; x0 += kBlock)
      if (near_[block(x0, y, z)])
        for (int x = std::max(x0, first); x < std::min(x0 + kBlock, points_[0] - 1); ++x) visit(x);
  }

  void sample() {
    for (int z = 0; z < points_[2]; z += kCoarse)
      for (int y = 0; y < points_[1]; y += kCoarse)
        for (int x = 0; x < points_[0]; x += kCoarse) sample_block(x, y, z, kCoarse);
  }

  void sample_block(int x0, int y0, int z0, int size) {
    // The 1 makes the cells between this block's last points and the next block's first points count for
    // both.
    const float reach = 0.8660254f * float(size + 1);  // half the block's diagonal, in cells
    const float half = 0.5f * float(size - 1);
    const float middle = field_(point(float(x0) + half, float(y0) + half, float(z0) + half));
    const bool far = std::abs(middle) > kSlope * reach * cell_;
    if (!far && size == kBlock) near_[block(x0, y0, z0)] = 1;
    const int step = far || size == kBlock ? 1 : kBlock;
    for (int z = z0; z < z0 + size; z += step)
      for (int y = y0; y < y0 + size; y += step)
        for (int x = x0; x < x0 + size; x += step) {
          if (step > 1)
            sample_block(x, y, z, kBlock);
          else
            values_[size_t(z) * size_t(points_[0]) * size_t(points_[1]) + slot(x, y)] =
                far ? middle : field_(point(float(x), float(y), float(z)));
        }
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

  // Adds the faces of the lattice edges in plane z (along x and y) and of the edges that leave it (along z).
  void add_faces(const std::vector<uint32_t>& below, const std::vector<uint32_t>& above, int z) {
    for (int y = 1; y + 1 < points_[1]; ++y)
      for_near_points(1, y, z, [&](int x) {
        const bool here = value(x, y, z) < 0;
        if (here != (value(x + 1, y, z) < 0))
          add_quad(below[slot(x, y - 1)], below[slot(x, y)], above[slot(x, y)], above[slot(x, y - 1)], !here);
        if (here != (value(x, y + 1, z) < 0))
          add_quad(below[slot(x - 1, y)], below[slot(x, y)], above[slot(x, y)], above[slot(x - 1, y)], here);
        if (here != (value(x, y, z + 1) < 0))
          add_quad(above[slot(x - 1, y - 1)], above[slot(x, y - 1)], above[slot(x, y)], above[slot(x - 1, y)],
                   !here);
      });
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
  std::vector<uint8_t> near_;  // one for each block of kBlock points a side: whether the surface may be in it
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

Model surface_of(const DistanceField& field, const Bounds& box, float cell, int32_t material) {
  return SurfaceNets(field, box, cell, material).run();
}

}  // namespace glint::scenes
