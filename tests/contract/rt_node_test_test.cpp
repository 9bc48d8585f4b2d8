// Tests that every registered node test keeps the promises of rtunit/node_test.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string>

#include "base/registry.h"
#include "rtunit/node_test.h"
#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"

namespace glint::rt::test {
namespace {

// Calls each(fetch) for the nodes that some rays visit.
template <class Each>
void for_visited_nodes(const mem::AddressSpace& memory, const StructureInfo& top, Each&& each) {
  Random random{4};
  for (int i = 0; i < 50; ++i) {
    RayState ray = ray_of(top.address, random.point(12), random.point(1), 0, 60);
    REQUIRE(begin(ray, memory));
    while (ray.status == RayStatus::Traversing) {
      const Fetch node = next_fetch(ray);
      each(node);
      step(ray, memory.find(node.address, node.bytes));
    }
  }
}

TEST_CASE("the test of a node takes at least one start, and always as many") {
  Random random{8};
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(soup(random, 300, 8, 3)));
  REQUIRE(Registry<NodeTest>::names().size() >= 2);
  for (const std::string& name : Registry<NodeTest>::names()) {
    CAPTURE(name);
    const auto& entry = Registry<NodeTest>::instance().entry(name);
    const auto a = entry.make_default({memory}), b = entry.make_default({memory});
    for_visited_nodes(memory, top, [&](const Fetch& node) {
      REQUIRE(a->starts(node) >= 1);
      REQUIRE(a->starts(node) == b->starts(node));
    });
  }
}

TEST_CASE("nodes of more than 64 B take two starts by their bytes, and one by node") {
  const auto most_starts = [](const char* format, const char* test) {
    Random random{8};
    mem::AddressSpace memory;
    const StructureInfo top = single(memory, triangles(soup(random, 300, 8, 3)), BuildOptions{format, true});
    const auto policy = Registry<NodeTest>::instance().entry(test).make_default({memory});
    uint32_t most = 0;
    for_visited_nodes(memory, top, [&](const Fetch& node) {
      if (node.kind == NodeKind::Internal) most = std::max<uint32_t>(most, policy->starts(node));
    });
    return most;
  };
  CHECK(most_starts("bvh6", "by_node") == 1);
  CHECK(most_starts("bvh4", "by_node") == 1);
  CHECK(most_starts("bvh6", "by_bytes") == 1);
  CHECK(most_starts("bvh4", "by_bytes") == 2);
  CHECK(most_starts("bvh8", "by_bytes") == 2);
}

}  // namespace
}  // namespace glint::rt::test
