// Tests that children lie in the slots in which rays of every octant meet them from front to back.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/formats/octant_slots.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "rtunit/structure/build.h"
#include "rtunit/traversal/traversal.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

Bounds cube(float x, float y, float z) {
  return {{x - 1, y - 1, z - 1}, {x + 1, y + 1, z + 1}};
}

TEST_CASE(
    "eight boxes at the corners of a cube get the slots of their corners, in whatever order they come") {
  Random random{3};
  for (int round = 0; round < 20; ++round) {
    std::vector<uint32_t> corners{0, 1, 2, 3, 4, 5, 6, 7};
    for (size_t i = 8; i > 1; --i) std::swap(corners[i - 1], corners[random.below(uint32_t(i))]);
    std::vector<Bounds> boxes;
    for (const uint32_t c : corners)
      boxes.push_back(cube(c & 1 ? 9.f : -9.f, c & 2 ? 9.f : -9.f, c & 4 ? 9.f : -9.f));
    const auto slots = octant_slots(boxes);
    for (size_t i = 0; i < 8; ++i) CHECK(slots[i] == corners[i]);
  }
}

// Returns the sum that octant_slots() makes as large as possible, for boxes whose node has its centre at 0.
double sum_of(const std::vector<Bounds>& boxes, const std::vector<uint32_t>& slots) {
  double sum = 0;
  for (size_t i = 0; i < boxes.size(); ++i)
    for (size_t a = 0; a < 3; ++a)
      sum += (slots[i] >> a & 1 ? 1 : -1) * (double(boxes[i].low[a]) + boxes[i].high[a]) / 2;
  return sum;
}

double best_sum(const std::vector<Bounds>& boxes, std::vector<uint32_t>& slots) {
  if (slots.size() == boxes.size()) return sum_of(boxes, slots);
  double best = -1e30;
  for (uint32_t slot = 0; slot < kSlots; ++slot) {
    if (std::count(slots.begin(), slots.end(), slot)) continue;
    slots.push_back(slot);
    best = std::max(best, best_sum(boxes, slots));
    slots.pop_back();
  }
  return best;
}

TEST_CASE("no other choice of slots has a larger sum") {
  Random random{11};
  for (int round = 0; round < 60; ++round) {
    std::vector<Bounds> boxes{cube(-20, -20, -20), cube(20, 20, 20)};  // They hold the centre at 0.
    for (uint32_t more = random.below(4); more; --more) {
      const auto p = random.point(19);
      boxes.push_back(cube(p[0], p[1], p[2]));
    }
    const auto slots = octant_slots(boxes);
    std::vector<uint32_t> none;
    const double best = best_sum(boxes, none);
    const double ours = sum_of(boxes, {slots.begin(), slots.begin() + ptrdiff_t(boxes.size())});
    CHECK(ours == Approx(best).epsilon(1e-9));
    for (size_t i = 0; i < boxes.size(); ++i)
      for (size_t k = 0; k < i; ++k) CHECK(slots[i] != slots[k]);
  }
}

// Eight triangles at the corners of a cube have one node above them.
TEST_CASE("in the order by octant, a ray from every corner visits its nearest triangle first") {
  Positions positions;
  for (uint32_t c = 0; c < 8; ++c) {
    const float x = c & 1 ? 9.f : -9.f, y = c & 2 ? 9.f : -9.f, z = c & 4 ? 9.f : -9.f;
    for (const auto& p : {std::array{x - 1, y, z}, std::array{x + 1, y + 1, z}, std::array{x, y - 1, z + 1}})
      positions.push_back(p);
  }
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(positions), {"cwbvh", false});
  const auto order = Registry<ChildOrder>::instance().entry("octant").make_default({});
  for (uint32_t c = 0; c < 8; ++c) {
    CAPTURE(c);
    const std::array corner{c & 1 ? 9.f : -9.f, c & 2 ? 9.f : -9.f, c & 4 ? 9.f : -9.f};
    RayState ray = ray_of(top.address, {2 * corner[0], 2 * corner[1], 2 * corner[2]},
                          {-corner[0], -corner[1], -corner[2]});
    REQUIRE(begin(ray, memory));
    ray.rules.order = order.get();
    // The root of the top level, the instance and the root of the bottom level come before the first leaf.
    for (int i = 0; i < 3; ++i) {
      const Fetch next = next_fetch(ray);
      REQUIRE(next.kind != NodeKind::Triangle);
      step(ray, memory.find(next.address, next.bytes));
    }
    const Fetch leaf = next_fetch(ray);
    REQUIRE(leaf.kind == NodeKind::Triangle);
    CHECK(memory.view<TriangleLeaf>(leaf.address, 1)[0].primitive[0] == c);
  }
}

}  // namespace
}  // namespace glint::rt::test
