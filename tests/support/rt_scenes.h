// Makes random scenes for the RT unit's tests: a deterministic generator, soups of triangles, transforms.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "memsys/address_space.h"
#include "rtunit/structure/build.h"
#include "rtunit/traversal/traversal.h"

namespace glint::rt::test {

// Draws random numbers by a generator of its own, because distributions of std differ between standard
// libraries.
struct Random {
  uint64_t state;
  uint32_t bits() {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return uint32_t(state >> 32);
  }
  float uniform(float low, float high) { return low + (high - low) * float(bits() >> 8) * 0x1p-24f; }
  uint32_t below(uint32_t n) { return uint32_t(uint64_t(bits()) * n >> 32); }
  std::array<float, 3> point(float size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
};

using Positions = std::vector<std::array<float, 3>>;

inline Geometry triangles(const Positions& positions, bool opaque = true) {
  Geometry out;
  out.positions = std::as_bytes(std::span(positions));
  out.opaque = opaque;
  return out;
}

inline Positions soup(Random& random, uint32_t count, float size, float edge) {
  Positions out;
  for (uint32_t i = 0; i < count; ++i) {
    const auto p = random.point(size);
    for (int c = 0; c < 3; ++c) {
      const auto d = random.point(edge);
      out.push_back({p[0] + d[0], p[1] + d[1], p[2] + d[2]});
    }
  }
  return out;
}

// Returns a rotation about a random axis, a scale (mirrored when negative) and a translation.
inline std::array<float, 12> random_transform(Random& random, float scale, float distance) {
  float q[4], length = 0;
  for (float& x : q) x = random.uniform(-1, 1), length += x * x;
  length = std::sqrt(length);
  for (float& x : q) x /= length;
  const float w = q[0], x = q[1], y = q[2], z = q[3];
  const float r[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                      2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                      2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  const auto t = random.point(distance);
  std::array<float, 12> m;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) m[4 * i + j] = scale * r[3 * i + j] * (j == 0 && scale < 0 ? 1.5f : 1.0f);
    m[4 * i + 3] = t[i];
  }
  return m;
}

inline RayState ray_of(Address structure, std::array<float, 3> origin, std::array<float, 3> direction,
                       float t_min = 0, float t_max = INFINITY, uint32_t flags = 0) {
  RayState state;
  state.ray.origin = origin;
  state.ray.direction = direction;
  state.ray.t_min = t_min;
  state.ray.t_max = t_max;
  state.ray.flags = flags;
  state.ray.structure = structure;
  return state;
}

// Returns a single instance of one geometry, with the identity transform.
inline StructureInfo single(mem::AddressSpace& memory, const Geometry& geometry,
                            const BuildOptions& options = {}) {
  const StructureInfo bottom = build_bottom(memory, "bottom", {{geometry}}, options);
  return build_top(memory, "top", std::vector<Instance>(1), std::vector{bottom}, options);
}

}  // namespace glint::rt::test
