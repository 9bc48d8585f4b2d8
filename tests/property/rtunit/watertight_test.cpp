// Tests that closed meshes never leak: a ray from inside always hits, through edges and vertices, too.
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

// Returns an octahedron split `levels` times. Its vertices are moved to distances of 1 to 1.3 by a rule that
// neighbours share.
Positions bumpy_sphere(int levels, float size, const std::array<float, 3>& center) {
  Positions faces;
  for (int i = 0; i < 8; ++i) {
    const float x = i & 1 ? -1.f : 1.f, y = i & 2 ? -1.f : 1.f, z = i & 4 ? -1.f : 1.f;
    for (const std::array<float, 3>& p : {std::array{x, 0.f, 0.f}, {0.f, y, 0.f}, {0.f, 0.f, z}})
      faces.push_back(p);
  }
  for (int level = 0; level < levels; ++level) {
    Positions next;
    for (size_t t = 0; t < faces.size(); t += 3) {
      std::array<std::array<float, 3>, 6> p{faces[t], faces[t + 1], faces[t + 2]};
      for (size_t e = 0; e < 3; ++e)
        for (size_t k = 0; k < 3; ++k)
          p[3 + e][k] = (p[e][k] + p[(e + 1) % 3][k]) / 2;  // exact: the same from both sides
      for (size_t k : {0, 3, 5, 3, 1, 4, 5, 4, 2, 3, 4, 5}) next.push_back(p[k]);
    }
    faces = next;
  }
  for (auto& p : faces) {
    uint32_t h = 1;
    for (float x : p) h = h * 31 + uint32_t(int32_t(x * 4096));
    const float r = 1 + 0.3f * float(h * 2654435761u >> 16) / 65536;
    for (size_t k = 0; k < 3; ++k) p[k] = center[k] + size * r * p[k];
  }
  return faces;
}

uint32_t leaks(const Positions& mesh, Address top, const mem::AddressSpace& memory,
               const std::array<float, 3>& center, float size, uint32_t num_rays, uint64_t seed) {
  Random random{seed};
  uint32_t out = 0;
  for (uint32_t i = 0; i < num_rays; ++i) {
    const size_t t = 3 * random.below(uint32_t(mesh.size() / 3));
    const float a = i % 3 ? random.uniform(0, 1) : 0;  // a third aims at a vertex, the rest at an edge
    auto origin = center;
    const auto offset = random.point(0.1f * size);
    std::array<float, 3> direction;
    for (size_t k = 0; k < 3; ++k) {
      if (i % 2) origin[k] += offset[k];
      direction[k] = mesh[t][k] * (1 - a) + mesh[t + 1][k] * a - origin[k];
    }
    RayState state = ray_of(top, origin, direction);
    REQUIRE(begin(state, memory));
    run(state, memory);
    out += !state.committed.valid();
  }
  return out;
}

TEST_CASE("no ray through an edge or a vertex leaves a closed mesh unseen") {
  const std::array<float, 3> centers[] = {{0, 0, 0}, {1000, -2000, 500}};
  for (const auto& center : centers)
    for (float size : {1e-3f, 1.f, 1e6f}) {
      if (size < 1 && center[0] != 0) continue;  // vertices of such a mesh collapse in float
      const Positions mesh = bumpy_sphere(5, size, center);
      mem::AddressSpace memory;
      const StructureInfo top = single(memory, triangles(mesh));
      CAPTURE(size, center[0]);
      CHECK(leaks(mesh, top.address, memory, center, size, 40000, 11) == 0);
    }
}

TEST_CASE("a leak would be seen: the same rays find the hole of a missing triangle") {
  Positions mesh = bumpy_sphere(3, 1, {0, 0, 0});
  const Positions whole = mesh;
  mesh.resize(mesh.size() - 3);
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(mesh));
  CHECK(leaks(whole, top.address, memory, {0, 0, 0}, 1, 40000, 12) > 0);
}

}  // namespace
}  // namespace glint::rt::test
