// Reads the triangles and boxes of a bottom level's input.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/input_primitives.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "base/diagnostics.h"

namespace glint::rt {
namespace {

bool has_area(const Triangle& t) {
  double a[3], b[3];
  for (size_t i = 0; i < 3; ++i) {
    a[i] = double(t[1][i]) - t[0][i];
    b[i] = double(t[2][i]) - t[0][i];
  }
  return a[1] * b[2] != a[2] * b[1] || a[2] * b[0] != a[0] * b[2] || a[0] * b[1] != a[1] * b[0];
}

Position transformed(const std::array<float, 12>& m, const Position& p) {
  Position out;
  for (size_t r = 0; r < 3; ++r)
    out[r] = ((m[4 * r] * p[0] + m[4 * r + 1] * p[1]) + m[4 * r + 2] * p[2]) + m[4 * r + 3];
  return out;
}

}  // namespace

bool is_finite(const Bounds& bounds) {
  return std::all_of(bounds.low.begin(), bounds.low.end(), [](float x) { return std::isfinite(x); }) &&
         std::all_of(bounds.high.begin(), bounds.high.end(), [](float x) { return std::isfinite(x); });
}

uint64_t num_triangles(const Geometry& g) {
  return (g.indices.empty() ? (g.positions.size() + g.stride - 12) / g.stride : g.indices.size()) / 3;
}

uint64_t num_primitives(const Geometry& g) {
  if (!g.aabbs.empty()) return g.aabbs.size();
  return g.positions.empty() ? 0 : num_triangles(g);
}

std::optional<Triangle> corners_at(const Geometry& g, uint64_t index) {
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
  return out;
}

std::optional<Triangle> triangle_at(const Geometry& g, uint64_t index) {
  std::optional<Triangle> out = corners_at(g, index);
  if (out && !has_area(*out)) out.reset();
  return out;
}

bool is_active(const Bounds& box) {
  return is_finite(box) && box.low[0] <= box.high[0] && box.low[1] <= box.high[1] &&
         box.low[2] <= box.high[2];
}

}  // namespace glint::rt
