// Answers the reference renderer's rays, by Embree's triangle test or by our own test on every candidate.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>

#include "scenes/scene.h"
#include "tests/reference/vector.h"

namespace glint::reference {

struct Ray {
  Vec origin{}, direction{};
  float t_min = 0, t_max = 0;  // in lengths of `direction`
  bool opaque = true;          // false: passes where a triangle's texture has a hole
};

struct Hit {
  static constexpr uint32_t kMiss = ~0u;
  uint32_t model = kMiss;     // index into Scene::models
  uint32_t primitive = 0;     // triangle; 0 for a sphere
  float t = 0, u = 0, v = 0;  // weights of corners 1 and 2
  bool missed() const { return model == kMiss; }
};

// Finds the closest hit with t_min < t < t_max. Rays that may end at their first hit get the closest one,
// too.
class Intersector {
 public:
  virtual ~Intersector() = default;
  virtual Hit closest(const Ray& ray) = 0;
};

// Returns Embree's robust triangle test, with spheres by the intersection shader's formula.
std::unique_ptr<Intersector> make_embree_intersector(const scenes::Scene& scene);
// Returns the test of Woop, Benthin and Wald 2013 in scalar float for every triangle whose box the ray meets
// (Embree only finds the boxes). Equal distances go to the lowest (model, primitive).
std::unique_ptr<Intersector> make_exact_intersector(const scenes::Scene& scene);

// Does Woop's test on three corners: fills t, u, v and returns true when the ray's line meets the triangle.
// The caller checks t against the interval.
bool meets_triangle(const Ray& ray, const Vec& a, const Vec& b, const Vec& c, Hit& hit);

// Does the test of the sphere intersection shader. Returns a distance in [t_min, t_max), or a negative
// number.
float meets_sphere(const Ray& ray, const Vec& center, float radius);

}  // namespace glint::reference
