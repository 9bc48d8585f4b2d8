// Looks at the texels under each micro-triangle.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/opacity_bake.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <vector>

#include "exec/texture_address.h"

namespace glint::pipeline {
namespace {

using rt::MicromapFormat;
using rt::MicroState;

struct Point {
  double x = 0, y = 0;
};
using Corners = std::array<Point, 3>;

// A larger part of a texture is not looked at, and its state is unknown.
constexpr double kMostTexels = 1 << 22;

// Finds the states of one triangle's parts. Points are in texels, and the centre of texel i lies at i. So a
// sample mixes the texels that are less than 1 away from it in both directions.
class TriangleBake {
 public:
  TriangleBake(const AlphaTexture& texture, const std::array<scenes::Vec2, 3>& coordinates)
      : texture_(texture) {
    double farthest = 0;
    for (size_t i = 0; i < 3; ++i) {
      corner_[i] = {coordinates[i][0] * double(texture.width) - 0.5,
                    coordinates[i][1] * double(texture.height) - 0.5};
      for (const double x : {std::fabs(corner_[i].x), std::fabs(corner_[i].y)}) {
        is_sane_ = is_sane_ && x < 0x1p20;  // A coordinate that is not a number is not sane either.
        farthest = std::max(farthest, x);
      }
    }
    // The shader interpolates in floats, so that its sample may lie beside the micro-triangle.
    reach_ = 1 + 0x1p-6 + farthest * 0x1p-20;
  }

  MicroState state_of(const rt::MicroTriangle& part, double size, bool two_states) const {
    if (!is_sane_) return MicroState::UnknownOpaque;
    const double u = part.u, v = part.v;
    const Corners at = part.is_flipped
                           ? Corners{point(u + 1, v, size), point(u, v + 1, size), point(u + 1, v + 1, size)}
                           : Corners{point(u, v, size), point(u + 1, v, size), point(u, v + 1, size)};
    const Found found = look_at(at);
    if (!found.is_complete || (found.clear && found.solid)) {
      const Point centre{(at[0].x + at[1].x + at[2].x) / 3, (at[0].y + at[1].y + at[2].y) / 3};
      const bool passes = is_clear_at(centre);
      if (two_states) return passes ? MicroState::Transparent : MicroState::Opaque;
      return passes ? MicroState::UnknownTransparent : MicroState::UnknownOpaque;
    }
    return found.clear ? MicroState::Transparent : MicroState::Opaque;
  }

 private:
  // Says whether texels have alpha 0 (clear) or more (solid), as far as they have been looked at.
  struct Found {
    bool clear = false, solid = false, is_complete = true;
  };

  Point point(double u, double v, double size) const {
    const double a = u / size, b = v / size, c = 1 - a - b;
    return {c * corner_[0].x + a * corner_[1].x + b * corner_[2].x,
            c * corner_[0].y + a * corner_[1].y + b * corner_[2].y};
  }

  bool is_clear(int64_t x, int64_t y) const {
    const int64_t column = exec::wrap(texture_.wrap, x, texture_.width),
                  row = exec::wrap(texture_.wrap, y, texture_.height);
    return texture_.rgba[size_t(row * texture_.width + column) * 4 + 3] == 0;
  }

  // Returns what the alpha test says of a sample.
  bool is_clear_at(const Point& p) const {
    const double x = std::floor(p.x), y = std::floor(p.y);
    for (int i = 0; i < 4; ++i) {
      const bool right = i & 1, below = i & 2;
      if ((right && p.x == x) || (below && p.y == y)) continue;  // This texel has no weight.
      if (!is_clear(int64_t(x) + right, int64_t(y) + below)) return false;
    }
    return true;
  }

  // Looks at all texels that samples within a triangle can mix.
  Found look_at(const Corners& at) const {
    Found found;
    const auto [left, right] = std::minmax({at[0].x, at[1].x, at[2].x});
    const auto [top, bottom] = std::minmax({at[0].y, at[1].y, at[2].y});
    const auto first_x = int64_t(std::ceil(left - reach_)), last_x = int64_t(std::floor(right + reach_)),
               first_y = int64_t(std::ceil(top - reach_)), last_y = int64_t(std::floor(bottom + reach_));
    found.is_complete = double(last_x - first_x + 1) * double(last_y - first_y + 1) <= kMostTexels;
    if (!found.is_complete) return found;
    for (int64_t y = first_y; y <= last_y; ++y)
      for (int64_t x = first_x; x <= last_x; ++x) {
        if (!reaches(at, {double(x), double(y)})) continue;
        (is_clear(x, y) ? found.clear : found.solid) = true;
        if (found.clear && found.solid) return found;
      }
    return found;
  }

  // Returns whether a texel may be less than `reach_` from the triangle in both directions: it lies before
  // none of the triangle's edges by more. The caller has looked at the box around the triangle.
  bool reaches(const Corners& at, const Point& texel) const {
    for (size_t i = 0; i < 3; ++i) {
      const Point &a = at[i], &b = at[(i + 1) % 3], &inner = at[(i + 2) % 3];
      double x = a.y - b.y, y = b.x - a.x;  // the edge's normal
      const double side = x * (inner.x - a.x) + y * (inner.y - a.y);
      if (side == 0) continue;  // The triangle is a line or a point here.
      if (side < 0) x = -x, y = -y;
      if (x * (texel.x - a.x) + y * (texel.y - a.y) + (std::fabs(x) + std::fabs(y)) * reach_ < 0)
        return false;
    }
    return true;
  }

  const AlphaTexture& texture_;
  Corners corner_;
  double reach_ = 1;
  bool is_sane_ = true;
};

// Calls each(part) for every micro-triangle of a level.
template <class Each>
void for_each_part(uint32_t level, Each&& each) {
  const uint32_t size = 1u << level;
  for (uint32_t u = 0; u < size; ++u)
    for (uint32_t v = 0; u + v < size; ++v) {
      each(rt::MicroTriangle{u, v, false});
      if (u + v + 1 < size) each(rt::MicroTriangle{u, v, true});
    }
}

// Adds the map of a triangle, and returns what its index says.
int32_t add_map(const TriangleBake& triangle, rt::Micromaps& out) {
  const MicromapFormat& format = out.format;
  std::vector<uint8_t> map(format.bytes());
  uint32_t seen = 0;  // bit i: there is state i
  MicroState last{};
  for_each_part(format.level, [&](const rt::MicroTriangle& part) {
    last = triangle.state_of(part, double(1u << format.level), format.two_states);
    seen |= 1u << uint32_t(last);
    const uint32_t bit = rt::number_of(part, format.level) * format.bits();
    map[bit / 8] = uint8_t(map[bit / 8] | uint32_t(last) << bit % 8);
  });
  if ((seen & (seen - 1)) == 0) return rt::Micromaps::uniform(last);
  out.states.insert(out.states.end(), map.begin(), map.end());
  return int32_t(out.states.size() / map.size()) - 1;
}

}  // namespace

rt::Micromaps bake_opacity(const AlphaTriangles& triangles, const MicromapFormat& format) {
  rt::Micromaps out{format, {}, {}};
  std::map<std::array<uint32_t, 7>, int32_t> known;  // by texture and the bits of the coordinates
  for (size_t first = 0; first + 2 < triangles.indices.size(); first += 3) {
    std::array<const scenes::Vertex*, 3> corner;
    bool is_whole = true;
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t vertex = triangles.indices[first + i];
      is_whole = is_whole && vertex < triangles.vertices.size();
      corner[i] = is_whole ? &triangles.vertices[vertex] : nullptr;
    }
    if (!is_whole) {  // The builder says what is wrong.
      out.index.push_back(rt::Micromaps::uniform(MicroState::UnknownOpaque));
      continue;
    }
    // The shader takes the material of the first corner. Without a texture its alpha is 1.
    const int32_t texture = triangles.materials[size_t(corner[0]->material)].texture;
    if (texture < 0) {
      out.index.push_back(rt::Micromaps::uniform(MicroState::Opaque));
      continue;
    }
    std::array<scenes::Vec2, 3> at;
    std::array<uint32_t, 7> key{uint32_t(texture)};
    for (size_t i = 0; i < 3; ++i) {
      at[i] = corner[i]->texture_coordinate;
      key[1 + 2 * i] = std::bit_cast<uint32_t>(at[i][0]);
      key[2 + 2 * i] = std::bit_cast<uint32_t>(at[i][1]);
    }
    const auto [place, is_new] = known.try_emplace(key, 0);
    if (is_new) place->second = add_map(TriangleBake(triangles.textures[size_t(texture)], at), out);
    out.index.push_back(place->second);
  }
  return out;
}

}  // namespace glint::pipeline
