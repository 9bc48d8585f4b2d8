// Tests that every registered traversal order keeps the promises of rtunit/traversal_order.h.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/registry.h"
#include "rtunit/treelets.h"
#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"
#include "tests/support/rt_trace.h"
#include "tests/support/stat_listing.h"

namespace glint::rt::test {
namespace {

std::vector<WarpRays> rays_of(const BuiltScene& scene, uint64_t seed) {
  Random random{seed};
  std::vector<WarpRays> out(3);
  for (WarpRays& warp : out)
    for (RayState& state : warp) {
      state = ray_of(scene.top.address, random.point(15), random.point(1));
      state.ray.flags = std::array{0u, 4u, 5u, 0x100u}[random.below(4)];
      state.rules.end_at_first_hit = false;
      REQUIRE(begin(state, scene.memory));
    }
  return out;
}

Traced trace(const BuiltScene& scene, const Params& params, uint64_t seed, bool every_cycle) {
  return trace_rays(params, scene.memory, rays_of(scene, seed), mem::FixedLatencyMemory(30, 2), every_cycle);
}

TEST_CASE("no order changes a hit, with every layout, format, mapping and prefetcher") {
  uint64_t hits = 0, number = 0;
  const auto mappings = Registry<WorkMapping>::names(), prefetchers = Registry<Prefetcher>::names();
  const auto layouts = Registry<TreeLayout>::names(), formats = Registry<NodeFormat>::names();
  REQUIRE(Registry<TraversalOrder>::names().size() >= 3);
  for (const std::string& format : formats) {
    const Scene scene = crowd(20 + number, 60);
    for (const std::string& layout : layouts) {
      const BuiltScene built(scene, BuildOptions{format.c_str(), true, layout.c_str()});
      for (const std::string& name : Registry<TraversalOrder>::names())
        for (const bool retest : {true, false})
          for (const std::string& mapping : mappings) {
            Params params;
            params.order.name = name;
            params.stack.name = "full";
            params.mapping.name = mapping;
            params.retest = retest;
            params.prefetch.name = prefetchers[++number % prefetchers.size()];
            params.warps = uint32_t(1 + number % 3);
            CAPTURE(format, layout, name, retest, mapping, params.prefetch.name);
            REQUIRE(RtUnit::why_not_together(params).empty());
            const Traced a = trace(built, params, number, true), b = trace(built, params, number, false);
            CHECK(a.completion == b.completion);
            CHECK(glint::test::first_difference(a.stats, b.stats) == "");
            CHECK((a.count("arranged") != 0) == (name != TraversalOrder::kDepthFirst));
            std::vector<WarpRays> expected = rays_of(built, number);
            for (WarpRays& warp : expected)
              for (RayState& ray : warp) run_to_end(ray, built.memory);
            require_same_hits(a.rays, expected);
            hits += num_hits(expected);
          }
    }
  }
  CHECK(hits > 1000);
}

// Visits of one ray at a time, each in the bottom level of a single instance.
std::vector<Address> visits_of(const mem::AddressSpace& memory, Address top, Address bottom,
                               const std::string& order, const std::array<float, 3>& origin,
                               const std::array<float, 3>& direction) {
  Params params;
  params.order.name = order;
  params.stack.name = "full";
  params.retest = false;
  mem::FixedLatencyMemory l1(5, 1);
  RtUnit unit(params, {memory, l1, nullptr});
  std::vector<Address> out;
  unit.node_visited().listen([&](const NodeVisited& visit) {
    if (visit.node.address >> 32 == bottom >> 32) out.push_back(visit.node.address);
  });
  RayState ray = ray_of(top, origin, direction);
  REQUIRE(begin(ray, memory));
  std::vector<WarpRays> rays = one_lane(ray);
  launch(unit, l1, rays, false);
  return out;
}

TEST_CASE("breadth first goes level by level, and two stacks leave a treelet once") {
  Random random{12};
  const Positions positions = soup(random, 3000, 8, 2);
  mem::AddressSpace memory;
  const BuildOptions options{"bvh6", true, "treelet_breadth_first"};
  const StructureInfo bottom = build_bottom(memory, "b", {{triangles(positions)}}, options);
  const StructureInfo top = build_top(memory, "t", std::vector<Instance>(1), std::vector{bottom}, options);
  std::map<Address, uint32_t> depth{{bottom.address + kRootBlock * kBlockBytes, 0}};
  const auto format = make_format("bvh6");
  for (std::vector<Address> open{depth.begin()->first}; !open.empty();) {
    const Address at = open.back();
    open.pop_back();
    std::array<DecodedChild, kMaxWidth> children;
    const uint32_t count = format->decode(memory.find(at, 64), children);
    for (uint32_t i = 0; i < count; ++i) {
      const Address child = bottom.address + Address{block_of(children[i].node)} * kBlockBytes;
      depth[child] = depth[at] + 1;
      if (kind_of(children[i].node) == NodeKind::Internal) open.push_back(child);
    }
  }
  const Treelets treelets(memory);
  // Counts visits that go back to an upper level, and visits of a treelet that was left before.
  struct Steps {
    uint64_t visits = 0, upwards = 0, comebacks = 0;
  };
  const auto steps_of = [&](const std::string& order) {
    Steps out;
    Random rays{4};
    for (int i = 0; i < 60; ++i) {
      const auto origin = rays.point(12), direction = rays.point(1);
      uint32_t last_depth = 0;
      TreeletId last = kNoTreelet;
      std::set<TreeletId> left;
      for (const Address at : visits_of(memory, top.address, bottom.address, order, origin, direction)) {
        ++out.visits;
        out.upwards += depth.at(at) < last_depth;
        last_depth = depth.at(at);
        const TreeletId treelet = treelets.of(at);
        if (treelet == last) continue;
        out.comebacks += left.contains(treelet);
        left.insert(last);
        last = treelet;
      }
    }
    return out;
  };
  const Steps depth_first = steps_of("depth_first"), breadth_first = steps_of("breadth_first"),
              two_stacks = steps_of("two_stacks");
  CHECK(depth_first.upwards > 100);
  CHECK(depth_first.comebacks > 100);
  CHECK(breadth_first.upwards == 0);
  CHECK(two_stacks.comebacks == 0);
  CHECK(two_stacks.upwards > 100);
  // Levels are finished before a hit in the next one can spare a node.
  CHECK(breadth_first.visits > depth_first.visits);
}

TEST_CASE("an order falls back to depth first before a ray's stack is full") {
  // Overlapping triangles: a ray meets nearly all boxes, so a level is wider than any stack.
  Random random{3};
  const Positions positions = soup(random, 4000, 0.5f, 10);
  mem::AddressSpace memory;
  const StructureInfo bottom = build_bottom(memory, "b", {{triangles(positions)}});
  const StructureInfo top = build_top(memory, "t", std::vector<Instance>(1), std::vector{bottom});
  Params params;
  params.order.name = "breadth_first";
  params.stack.name = "full";
  mem::FixedLatencyMemory l1(5, 1);
  stats::Group root(nullptr, "test");
  RtUnit unit(params, {memory, l1, &root});
  RayState ray = ray_of(top.address, {0, 0, -30}, {0, 0, 1}), expected = ray;
  REQUIRE(begin(ray, memory));
  REQUIRE(begin(expected, memory));
  run(expected, memory);
  std::vector<WarpRays> rays = one_lane(ray);
  launch(unit, l1, rays, false);
  const RayState& found = rays[0][5];
  CHECK_FALSE(found.broken);
  REQUIRE(expected.committed.valid());
  CHECK(same_hit(expected.committed, found.committed));
  CHECK(found.stack_peak > 100);
  CHECK(found.stack_peak <= kStackEntries);
  CHECK(glint::test::counter_in(glint::test::listing(root), "without_room") > 10);
}

TEST_CASE("orders are refused with stacks and entries that live on depth first, with a reason") {
  for (const std::string& name : Registry<TraversalOrder>::names()) {
    const bool is_depth_first = name == TraversalOrder::kDepthFirst;
    for (const char* stack : {"short_stack", "restart_trail", "full"}) {
      Params params;
      params.order.name = name;
      params.stack.name = stack;
      CAPTURE(name, stack);
      const std::string why = RtUnit::why_not_together(params);
      CHECK(why.empty() == (is_depth_first || params.stack.name == "full"));
      if (!why.empty()) CHECK(why.find(stack) != std::string::npos);
    }
    Params params;
    params.order.name = name;
    params.stack.name = "full";
    params.entry.name = "predictor";
    CHECK(RtUnit::why_not_together(params).empty() == is_depth_first);
  }
}

}  // namespace
}  // namespace glint::rt::test
