// Compares a record with the recorded one. A difference is explained by a rule that is checked, or is a
// failure.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "tests/vulkan_rt/recording.h"

namespace glint::vulkan_rt {

// Says where exact arithmetic sees a primitive on the line of a ray.
struct Exact {
  bool on_line = false;  // the line meets the plane, or the sphere
  double t = 0;          // of the plane; of the nearer root
  double t_far = 0;      // sphere: t of the farther root
  double u = 0, v = 0;   // triangle: weights of the second and third corner
  double slope = 1;      // triangle: cosine between normal and ray; sphere: root of the relative discriminant
  // What one rounding to 24 bits of the largest number on the way does to t, to a weight (triangle) and to
  // the normal (sphere), to first order.
  double t_unit = 0, weight_unit = 0;
};
Exact exact(const Recording& r, const Ray& ray, uint32_t instance, uint32_t geometry, uint32_t primitive);

struct Tally {
  uint32_t rays = 0, equal = 0, different = 0;
  std::map<std::string, uint32_t> explained;  // ordered by rule
  std::string first_different;                // for the message
  uint32_t num_explained() const;
  std::string line(const std::string& name) const;
};

// Compares all rays of a mode. `ours` and `theirs` hold one record per ray.
Tally compare(const Recording& r, const Mode& mode, const Record* ours, const Record* theirs);

}  // namespace glint::vulkan_rt
