// Every registered node format keeps the promises of rtunit/node_format.h, and rays see the same through it.
// SPDX-License-Identifier: Apache-2.0
#include "base/registry.h"
#include "rtunit/node_format.h"
#include "rtunit/validate.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

TEST_CASE("every node format encodes sound structures, the same every time") {
  Random random{6};
  const Positions positions = soup(random, 3000, 10, 1);
  for (const std::string& name : Registry<NodeFormat>::names()) {
    CAPTURE(name);
    mem::AddressSpace a, b;
    const StructureInfo first = single(a, triangles(positions), {name}), second = single(b, triangles(positions), {name});
    CHECK(validate(a, first.address).empty());
    REQUIRE(first.bytes == second.bytes);
    CHECK(std::memcmp(a.find(first.address, first.bytes), b.find(second.address, second.bytes), first.bytes) == 0);
    const auto format = make_format(name);
    CHECK(format->width() >= 2);
    REQUIRE(make_format(format->id()) != nullptr);
    CHECK(make_format(format->id())->width() == format->width());
  }
}

TEST_CASE("in every node format a ray finds what testing every triangle finds") {
  Random random{7};
  const Positions positions = soup(random, 300, 10, 3);
  for (const std::string& name : Registry<NodeFormat>::names()) {
    mem::AddressSpace memory, alone;
    const StructureInfo top = single(memory, triangles(positions), {name});
    std::vector<StructureInfo> singles;
    for (size_t i = 0; i < positions.size(); i += 3)
      singles.push_back(single(alone, triangles({positions.begin() + long(i), positions.begin() + long(i) + 3}), {name}));
    for (int i = 0; i < 300; ++i) {
      const auto origin = random.point(12), direction = random.point(1);
      RayState state = ray_of(top.address, origin, direction);
      REQUIRE(begin(state, memory));
      run(state, memory);
      float nearest = INFINITY;
      for (const StructureInfo& one : singles) {
        RayState other = ray_of(one.address, origin, direction);
        REQUIRE(begin(other, alone));
        run(other, alone);
        nearest = std::fmin(nearest, other.committed.t);
      }
      REQUIRE(state.committed.t == nearest);
    }
  }
}

}  // namespace
}  // namespace glint::rt::test
