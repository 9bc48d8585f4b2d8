// Checks in double precision the rules by which two correct implementations may differ (README.md).
// SPDX-License-Identifier: Apache-2.0
#include "tests/vulkan_rt/compare.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>

namespace glint::vulkan_rt {
namespace {

using Double3 = std::array<double, 3>;

constexpr uint32_t kTriangle = 1, kSphere = 2;  // Record::kind of hits
constexpr uint32_t kTerminateOnFirstHit = 0x4;
constexpr double kTolerance = 1e-5;  // relative, of t; absolute, of weights
constexpr double kUnit = 0x1p-24;    // half a unit in the last place, relative
// A shader, or a unit for triangles, may make this many roundings, all in one direction, on the way to a
// result.
constexpr double kRoundings = 16;

Double3 sub(const Double3& a, const Double3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Double3& a, const Double3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Double3 wide(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

// Transforms into the object space of an instance, by solving the 3x3 system with Cramer's rule.
Double3 to_object(const Instance& instance, Double3 x, bool point) {
  const auto& m = instance.transform;
  if (point) x = sub(x, {m[3], m[7], m[11]});
  const Double3 a{m[0], m[4], m[8]}, b{m[1], m[5], m[9]}, c{m[2], m[6], m[10]};
  const double det = dot(a, cross(b, c));
  return {dot(x, cross(b, c)) / det, dot(a, cross(x, c)) / det, dot(a, cross(b, x)) / det};
}

double largest(const Double3& x) {
  return std::max({std::fabs(x[0]), std::fabs(x[1]), std::fabs(x[2])});
}
double length(const Double3& x) {
  return std::sqrt(dot(x, x));
}

Exact exact_triangle(const Double3& o, const Double3& d, const Double3& p0, const Double3& p1,
                     const Double3& p2) {
  const Double3 e1 = sub(p1, p0), e2 = sub(p2, p0), p = cross(d, e2), s = sub(o, p0), q = cross(s, e1),
                n = cross(e1, e2);
  const double det = dot(e1, p);
  if (det == 0) return {};
  Exact out{true, dot(e2, q) / det, 0, dot(s, p) / det, dot(d, q) / det, 1, 0, 0};
  out.slope = std::fabs(dot(n, d)) / (length(n) * length(d));
  // This is the shift of the plane or of the ray by a unit of the coordinates' size.
  const double across =
      kUnit *
      (largest(o) + std::max({largest(p0), largest(p1), largest(p2)}) + std::fabs(out.t) * largest(d)) /
      out.slope;
  const double altitude = length(n) / std::max({length(e1), length(e2), length(sub(p2, p1))});
  out.t_unit = across / length(d);
  out.weight_unit = across / altitude;
  return out;
}

Exact exact_sphere(const Double3& o, const Double3& d, const std::array<float, 4>& sphere) {
  const Double3 oc = sub(o, {sphere[0], sphere[1], sphere[2]});
  const double a = dot(d, d), b = dot(oc, d), c = dot(oc, oc) - double(sphere[3]) * double(sphere[3]);
  const double discriminant = b * b - a * c;
  // The slope is 1 where the ray goes through the centre.
  const double slope = std::sqrt(std::fabs(discriminant)) / (std::sqrt(a) * double(sphere[3]));
  if (discriminant < 0) return {false, -b / a, -b / a, 0, 0, slope, 0, 0};
  Exact out{true, (-b - std::sqrt(discriminant)) / a, (-b + std::sqrt(discriminant)) / a, 0, 0, slope, 0, 0};
  // The shader takes a product from a square, and what is lost there moves the root.
  out.t_unit =
      kUnit * (b * b + std::fabs(a * c)) / (a * std::sqrt(discriminant)) + kUnit * std::fabs(out.t_far);
  out.weight_unit = (out.t_unit * std::sqrt(a) + kUnit * largest(oc)) / double(sphere[3]);
  return out;
}

bool is_hit(const Record& r) {
  return r.kind == kTriangle || r.kind == kSphere;
}
bool same_bits(float a, float b) {
  return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
}
bool near(double a, double b, double tolerance) {
  return std::fabs(a - b) <= tolerance;
}
bool near_vector(const Vec3& a, const Vec3& b) {
  double size = 1;
  for (float x : a) size = std::max(size, std::fabs(double(x)));
  for (size_t i = 0; i < 3; ++i)
    if (!near(a[i], b[i], kTolerance * size)) return false;
  return true;
}

// Compares everything that is not a number of the hit's place.
bool same_identity(const Record& a, const Record& b) {
  return a.kind == b.kind && a.instance == b.instance && a.custom == b.custom && a.primitive == b.primitive &&
         a.geometry == b.geometry && a.hit_kind == b.hit_kind && a.tag == b.tag && a.flags == b.flags &&
         a.call == b.call && same_bits(a.tmin, b.tmin);
}
bool same_place(const Record& a, const Record& b) {
  return near(a.t, b.t, kTolerance * std::fabs(double(b.t))) && near(a.u, b.u, kTolerance) &&
         near(a.v, b.v, kTolerance) && near(a.nx, b.nx, kTolerance) && near(a.ny, b.ny, kTolerance);
}
bool same_ray(const Record& a, const Record& b) {
  return near_vector(a.origin, b.origin) && near_vector(a.direction, b.direction);
}

double border(const Exact& e) {
  return std::min({e.u, e.v, 1 - e.u - e.v});
}

class Judge {
 public:
  Judge(const Recording& r, const Mode& mode, const Ray& ray) : r_(r), mode_(mode), ray_(ray) {}

  // Returns the name of the rule that explains the difference, or "" when none does.
  std::string explain(const Record& ours, const Record& theirs) const {
    if (ours.call != theirs.call) return "";
    if (counts_all() && (ours.anyhits != theirs.anyhits || ours.hash != theirs.hash))
      return same_identity(ours, theirs) && counts_differ_by_touched_sphere(ours, theirs) ? "sphere touched"
                                                                                          : "";
    if (same_identity(ours, theirs))
      return same_ray(ours, theirs) && is_where_it_says(ours) && is_where_it_says(theirs) &&
                     same_normal(ours, theirs)
                 ? "rounding"
                 : "";
    if (first_hit_mode() && is_hit(ours) && is_hit(theirs) && is_where_it_says(ours) &&
        is_where_it_says(theirs))
      return "any first hit";
    if (on_shared_edge(ours, theirs)) return "shared edge";
    if (touches_sphere(ours, theirs) || touches_sphere(theirs, ours)) return "sphere touched";
    return "";
  }

  // Says whether counts are comparable. Any-hit shaders that ignore everything are called once for each hit,
  // in whatever order.
  bool counts_all() const { return mode_.any_hit_mode == 2; }

 private:
  bool first_hit_mode() const { return (mode_.ray_flags & kTerminateOnFirstHit) || mode_.any_hit_mode == 3; }

  Exact exact_of(const Record& hit) const {
    return exact(r_, ray_, hit.instance, hit.geometry, hit.primitive);
  }

  // Returns whether the hit's distance and weights are those of exact arithmetic, as near as single precision
  // comes.
  bool is_where_it_says(const Record& hit) const {
    if (!is_hit(hit)) return false;
    const Exact e = exact_of(hit);
    if (!e.on_line) return false;
    const double t = hit.kind == kSphere && hit.hit_kind == 2 ? e.t_far : e.t;
    if (!near(hit.t, t, kRoundings * e.t_unit)) return false;
    const double weight = kRoundings * e.weight_unit;
    return hit.kind == kSphere ||
           (near(hit.u, e.u, weight) && near(hit.v, e.v, weight) && border(e) >= -weight);
  }

  // Compares normals. The normal of a sphere carries the error of t; a triangle's does not depend on the hit.
  bool same_normal(const Record& ours, const Record& theirs) const {
    const double error =
        std::max(kTolerance, ours.kind == kSphere ? 2 * kRoundings * exact_of(ours).weight_unit : 0);
    return near(ours.nx, theirs.nx, error) && near(ours.ny, theirs.ny, error) &&
           (ours.kind != kSphere || (near(ours.u, theirs.u, error) && near(ours.v, theirs.v, error)));
  }

  // Returns whether two triangles of one instance were met at one distance, both at their border.
  bool on_shared_edge(const Record& ours, const Record& theirs) const {
    if (ours.kind != kTriangle || theirs.kind != kTriangle || ours.instance != theirs.instance) return false;
    const Exact a = exact_of(ours), b = exact_of(theirs);
    return is_where_it_says(ours) && is_where_it_says(theirs) &&
           near(a.t, b.t, kRoundings * (a.t_unit + b.t_unit)) &&
           std::fabs(border(a)) <= kRoundings * a.weight_unit &&
           std::fabs(border(b)) <= kRoundings * b.weight_unit;
  }

  // Returns whether one of the two hit a sphere that the ray touches. Its discriminant is lost in rounding,
  // so the other may pass by.
  bool touches_sphere(const Record& hit, const Record& other) const {
    if (hit.kind != kSphere) return false;
    const Exact e = exact_of(hit);
    const bool lost = e.slope * e.slope < kTouching;
    return lost && (!is_hit(other) || is_where_it_says(other));
  }

  // Returns what sph.rahit adds to the hash for one report.
  static uint32_t hash_of(uint32_t instance, uint32_t primitive, uint32_t hit_kind) {
    return (instance * 73856093u) ^ (primitive * 19349663u) ^ (hit_kind << 20);
  }
  // Returns whether one of the two reported both roots of a sphere that the ray touches and the other none,
  // and that is all.
  bool counts_differ_by_touched_sphere(const Record& ours, const Record& theirs) const {
    const Record &more = ours.anyhits > theirs.anyhits ? ours : theirs,
                 &less = ours.anyhits > theirs.anyhits ? theirs : ours;
    for (uint32_t i = 0; i < r_.instances.size(); ++i) {
      const Geometry& g = r_.bottoms[r_.instances[i].bottom][0];
      for (uint32_t p = 0; !g.triangles && p < g.count; ++p) {
        const double slope = exact(r_, ray_, i, 0, p).slope;
        if (slope * slope < kTouching && more.anyhits - less.anyhits == 2 &&
            more.hash - less.hash == hash_of(i, p, 1) + hash_of(i, p, 2))
          return true;
      }
    }
    return false;
  }

  // This fraction of the squared radius is 16 roundings of the square of a distance of 6, for the smallest of
  // the spheres.
  static constexpr double kTouching = kRoundings * kUnit * 36 / (0.15 * 0.15);

  const Recording& r_;
  const Mode& mode_;
  const Ray& ray_;
};

std::string describe(const Record& r) {
  return fmt::format(
      "kind {} instance {} geometry {} primitive {} hit kind {:#x} tag {} t {} u {} v {} n {} {} call {:#x} "
      "flags {:#x}",
      r.kind, int32_t(r.instance), int32_t(r.geometry), int32_t(r.primitive), r.hit_kind, r.tag, r.t, r.u,
      r.v, r.nx, r.ny, r.call, r.flags);
}

}  // namespace

Exact exact(const Recording& r, const Ray& ray, uint32_t instance, uint32_t geometry, uint32_t primitive) {
  if (instance >= r.instances.size()) return {};
  const Instance& i = r.instances[instance];
  if (geometry >= r.bottoms[i.bottom].size() || primitive >= r.bottoms[i.bottom][geometry].count) return {};
  const Geometry& g = r.bottoms[i.bottom][geometry];
  const Double3 o = to_object(i, wide(ray.origin), true), d = to_object(i, wide(ray.direction), false);
  if (!g.triangles) return exact_sphere(o, d, r.spheres[primitive]);
  const auto corner = [&](uint32_t k) {
    const auto& v = r.vertices[g.first_vertex + 3 * primitive + k];
    return Double3{v[0], v[1], v[2]};
  };
  return exact_triangle(o, d, corner(0), corner(1), corner(2));
}

uint32_t Tally::num_explained() const {
  uint32_t sum = 0;
  for (const auto& [rule, count] : explained) sum += count;
  return sum;
}

std::string Tally::line(const std::string& name) const {
  std::string rules;
  for (const auto& [rule, count] : explained)
    rules += fmt::format("{}{} {}", rules.empty() ? " (" : ", ", count, rule);
  return fmt::format("{:15} {:5} rays {:5} equal {:4} explained{}{} {:3} different", name, rays, equal,
                     num_explained(), rules, rules.empty() ? "" : ")", different);
}

Tally compare(const Recording& r, const Mode& mode, const Record* ours, const Record* theirs) {
  Tally tally;
  for (uint32_t i = 0; i < r.rays_per_pattern; ++i) {
    const Record &a = ours[i], &b = theirs[i];
    ++tally.rays;
    const Judge judge(r, mode, r.ray(mode, i));
    const bool counts_agree = !judge.counts_all() || (a.anyhits == b.anyhits && a.hash == b.hash);
    if (counts_agree && same_identity(a, b) && same_place(a, b) && same_ray(a, b)) {
      ++tally.equal;
      continue;
    }
    const std::string rule = judge.explain(a, b);
    if (!rule.empty()) {
      ++tally.explained[rule];
    } else if (++tally.different <= 5) {
      const Exact x = exact(r, r.ray(mode, i), a.instance, a.geometry, a.primitive),
                  y = exact(r, r.ray(mode, i), b.instance, b.geometry, b.primitive);
      tally.first_different += fmt::format(
          "\n  ray {}: ours     {}\n          recorded {}\n    exact ours t {} u {} v {} slope {}, recorded "
          "t {} u {} v {} slope {}; any-hits {} and {}",
          i, describe(a), describe(b), x.t, x.u, x.v, x.slope, y.t, y.u, y.v, y.slope, a.anyhits, b.anyhits);
    }
  }
  return tally;
}

}  // namespace glint::vulkan_rt
