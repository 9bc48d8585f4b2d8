// The ray-triangle test: watertight along shared edges and vertices (Woop, Benthin, Wald 2013, JCGT 2-1).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "rtunit/ray_state.h"

namespace glint::rt {

struct TriangleHit {
  float t, u, v;  // distance in units of the direction; weights of vertices 1 and 2
  bool front;     // det > 0: the geometric normal (v1 - v0) x (v2 - v0) faces the ray's origin
};

// Sets what the tests derive from the ray's origin and direction (Woop et al. 2013, sec. 3).
inline void enter_space(RaySpace& space, const std::array<float, 3>& origin, const std::array<float, 3>& direction) {
  space.origin = origin;
  space.direction = direction;
  const float ax = std::fabs(direction[0]), ay = std::fabs(direction[1]), az = std::fabs(direction[2]);
  const uint8_t kz = ax > ay ? (ax > az ? 0 : 2) : (ay > az ? 1 : 2);
  uint8_t kx = kz == 2 ? 0 : uint8_t(kz + 1);
  uint8_t ky = kx == 2 ? 0 : uint8_t(kx + 1);
  if (direction[kz] < 0) std::swap(kx, ky);  // preserves the winding
  space.axis = {kx, ky, kz};
  for (int i = 0; i < 3; ++i) space.inverse_direction[i] = 1 / direction[i];
  space.shear = {direction[kx] / direction[kz], direction[ky] / direction[kz], 1 / direction[kz]};
}

// Tests the line of the ray; the interval is the caller's. False for degenerate triangles and for not-a-number.
inline bool intersect_triangle(const RaySpace& space, const std::array<float, 3>& p0, const std::array<float, 3>& p1,
                               const std::array<float, 3>& p2, TriangleHit& hit) {
  const auto [kx, ky, kz] = space.axis;
  const auto& o = space.origin;
  const float sx = space.shear[0], sy = space.shear[1], sz = space.shear[2];
  const float az = p0[kz] - o[kz], bz = p1[kz] - o[kz], cz = p2[kz] - o[kz];
  const float ax = (p0[kx] - o[kx]) - sx * az, ay = (p0[ky] - o[ky]) - sy * az;
  const float bx = (p1[kx] - o[kx]) - sx * bz, by = (p1[ky] - o[ky]) - sy * bz;
  const float cx = (p2[kx] - o[kx]) - sx * cz, cy = (p2[ky] - o[ky]) - sy * cz;
  // scaled barycentrics; exactly on an edge the sign needs the exact product
  float u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  if (u == 0 || v == 0 || w == 0) [[unlikely]] {
    u = float(double(cx) * double(by) - double(cy) * double(bx));
    v = float(double(ax) * double(cy) - double(ay) * double(cx));
    w = float(double(bx) * double(ay) - double(by) * double(ax));
  }
  const bool all_positive = u >= 0 && v >= 0 && w >= 0;
  const bool all_negative = u <= 0 && v <= 0 && w <= 0;
  if (!all_positive && !all_negative) return false;
  const float det = u + v + w;
  if (det == 0) return false;
  const float t = (u * (sz * az) + v * (sz * bz) + w * (sz * cz)) / det;
  hit = {t, v / det, w / det, det > 0};
  return t == t;
}

}  // namespace glint::rt
