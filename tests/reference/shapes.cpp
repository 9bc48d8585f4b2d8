// Tests the two shapes in scalar float: the watertight triangle and the shader's sphere.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

#include "tests/reference/intersector.h"

namespace glint::reference {
namespace {

struct Axes {
  int x, y, z;
};

float at(const Vec& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

// Permutes the axes by Woop et al. 2013, 3.2: z is the direction's largest component, and x and y keep the
// winding.
Axes permute(const Vec& d) {
  const float ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
  int z = 0;
  if (ay > ax) z = 1;
  if (az > (z == 1 ? ay : ax)) z = 2;
  Axes axes{(z + 1) % 3, (z + 2) % 3, z};
  if (at(d, z) < 0) std::swap(axes.x, axes.y);
  return axes;
}

// Holds the scaled signed area of two sheared corners. It is computed again in double when float says exactly
// zero.
struct Corner {
  float x, y, z;
};
float edge(const Corner& p, const Corner& q) {
  return p.x * q.y - p.y * q.x;
}
float edge_in_double(const Corner& p, const Corner& q) {
  return float(double(p.x) * double(q.y) - double(p.y) * double(q.x));
}

// Returns x, y or z of the normal from whichever corner's cross product cancels less, fused as in Embree's
// robust test.
float steadier(float p1, float p2, float q1, float q2, float r1, float r2) {
  const float first = p2 * q1, second = q2 * r1;
  if (std::abs(first) < std::abs(second)) return std::fma(p1, q2, -first);
  return std::fma(q1, r2, -second);
}

// Finds where the triangle's plane crosses the ray. Returns false when the plane is edge-on.
bool meets_plane(const Ray& ray, const Vec& a, const Vec& b, const Vec& c, float& t) {
  const Vec to_a = a - ray.origin, to_b = b - ray.origin, to_c = c - ray.origin;
  const Vec ac = to_c - to_a, ba = to_a - to_b, cb = to_b - to_c;
  const Vec normal{steadier(ac.y, ac.z, ba.y, ba.z, cb.y, cb.z), steadier(ac.z, ac.x, ba.z, ba.x, cb.z, cb.x),
                   steadier(ac.x, ac.y, ba.x, ba.y, cb.x, cb.y)};
  const float slope = 2.0f * fused_dot(normal, ray.direction);
  if (!(std::abs(slope) >= FLT_MIN)) return false;
  t = (1.0f / slope) * (2.0f * fused_dot(to_a, normal));
  return true;
}

}  // namespace

bool meets_triangle(const Ray& ray, const Vec& a, const Vec& b, const Vec& c, Hit& hit) {
  const Axes k = permute(ray.direction);
  const float dz = at(ray.direction, k.z);
  const float sx = at(ray.direction, k.x) / dz, sy = at(ray.direction, k.y) / dz, sz = 1.0f / dz;
  const auto shear = [&](const Vec& corner) -> Corner {
    const Vec p = corner - ray.origin;
    return {at(p, k.x) - sx * at(p, k.z), at(p, k.y) - sy * at(p, k.z), sz * at(p, k.z)};
  };
  const Corner pa = shear(a), pb = shear(b), pc = shear(c);
  float u = edge(pc, pb), v = edge(pa, pc), w = edge(pb, pa);
  if (u == 0 || v == 0 || w == 0) {
    u = edge_in_double(pc, pb);
    v = edge_in_double(pa, pc);
    w = edge_in_double(pb, pa);
  }
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const float determinant = u + v + w;
  if (determinant == 0) return false;
  // This is the plane's distance, unless it leaves the depths of the corners (slivers); then it is the
  // weighted one.
  float t = (u * pa.z + v * pb.z + w * pc.z) / determinant;
  if (t != t) return false;
  const auto [low, high] = std::minmax({pa.z, pb.z, pc.z});
  const float slack = std::max(std::abs(low), std::abs(high)) / 2097152.0f;
  float plane_t = 0;
  if (meets_plane(ray, a, b, c, plane_t) && plane_t >= low - slack && plane_t <= high + slack) t = plane_t;
  hit.t = t;
  hit.u = v / determinant;
  hit.v = w / determinant;
  return true;
}

float meets_sphere(const Ray& ray, const Vec& center, float radius) {
  const Vec offset = ray.origin - center;
  const float a = dot(ray.direction, ray.direction);
  const float b = dot(offset, ray.direction);
  const float c = dot(offset, offset) - radius * radius;
  const float discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return -1;
  const float t1 = (-b - std::sqrt(discriminant)) / a;
  const float t2 = (-b + std::sqrt(discriminant)) / a;
  if (ray.t_min <= t1 && t1 < ray.t_max) return t1;
  return ray.t_min <= t2 && t2 < ray.t_max ? t2 : -1;
}

}  // namespace glint::reference
