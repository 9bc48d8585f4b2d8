// Tests the published simulator's RT unit, one ray at a time, against the cycles of its own arithmetic.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/support/preset.h"
#include "tests/support/rt_launch.h"

namespace glint::rt::test {
namespace {

using glint::test::preset;

struct Scene {
  mem::AddressSpace memory;
  Positions positions;
  std::vector<Bounds> boxes;
  StructureInfo top;
  explicit Scene(const BuildOptions& options, bool procedural = false) {
    Random random{9};
    positions = soup(random, 500, 10, 2);
    Geometry geometry = triangles(positions);
    if (procedural) {
      for (size_t i = 0; i < positions.size(); i += 3) {
        const auto& p = positions[i];
        boxes.push_back({p, {p[0] + 1, p[1] + 1, p[2] + 1}});
      }
      geometry.positions = {};
      geometry.aabbs = boxes;
    }
    const StructureInfo bottom = build_bottom(memory, "bottom", {{geometry}}, options);
    std::vector<Instance> instances(8);
    for (size_t i = 0; i < instances.size(); ++i) {
      instances[i].transform = kIdentity;
      for (size_t a = 0; a < 3; ++a) instances[i].transform[4 * a + 3] = float(i >> a & 1) * 15;
    }
    top = build_top(memory, "top", instances, std::vector{bottom}, options);
  }
  RayState ray(uint64_t seed, float t_max = 100) const {
    Random random{seed};
    RayState state = ray_of(top.address, random.point(12), random.point(1), 0, t_max);
    REQUIRE(begin(state, memory));
    return state;
  }
};

// Returns the cycles from a ray's first request to the end of its last test, when all reads hit. A record of
// n requests whose test takes L keeps the ray for n + L - 1 cycles, because the test begins with the last
// request and the next request goes out when it ends.
Cycle sum_of_records(const RtStats& s) {
  const uint64_t instances = s.instance_leaves.value(), entered = s.headers.value() - s.rays.value();
  return 5 * s.rays.value() + 9 * s.internal_nodes.value() + 11 * instances + 5 * entered +
         (4 + 9) * (s.triangle_leaves.value() + s.procedural_leaves.value());
}
uint64_t sum_of_requests(const RtStats& s) {
  return 2 * s.headers.value() + 2 * s.internal_nodes.value() + 4 * s.instance_leaves.value() +
         (1 + 2) * (s.triangle_leaves.value() + s.procedural_leaves.value());
}

TEST_CASE(
    "a lone ray that misses takes header 5, internal node 9, instance 11 and 5, triangle 4 and 9 cycles") {
  for (const char* name : {"vulkan-sim-desktop", "vulkan-sim-mobile"}) {
    const pipeline::GpuParams gpu = preset(name);
    const Scene scene(gpu.bvh);
    int misses = 0;
    for (uint64_t seed = 1; seed < 60; ++seed)
      for (bool every_cycle : {true, false}) {
        mem::FixedLatencyMemory l1(gpu.memory.l1.hit_latency);
        RtUnit unit(gpu.rt, {scene.memory, l1});
        auto warps = one_lane(scene.ray(seed));
        const Launch done = launch(unit, l1, warps, every_cycle);
        const RtStats& s = unit.stats();
        CHECK(s.requests.value() == sum_of_requests(s));
        CHECK(s.descriptors.value() == s.triangle_leaves.value());
        if (s.hit_writes.value()) continue;
        misses += s.triangle_leaves.value() > 1;
        // It takes a cycle to enter and one to be given back.
        CHECK(done.last_completion == 1 + sum_of_records(s) + 1);
      }
    CHECK(misses > 4);
  }
}

TEST_CASE("each triangle met is a store at a place of its own that takes the port for a cycle") {
  pipeline::GpuParams gpu = preset("vulkan-sim-desktop");
  gpu.rt.shortcuts.store_latency = 0;
  const Scene scene(gpu.bvh);
  int hits = 0;
  for (uint64_t seed = 1; seed < 60; ++seed) {
    mem::FixedLatencyMemory l1(0);
    RtUnit unit(gpu.rt, {scene.memory, l1});
    auto warps = one_lane(scene.ray(seed));
    const RayState& ray = warps[0][5];
    uint32_t before_last = 0;
    unit.node_visited().listen([&](const NodeVisited&) { before_last = ray.hits_in_interval; });
    const Launch done = launch(unit, l1, warps, seed % 2);
    const RtStats& s = unit.stats();
    CHECK(s.hit_writes.value() == ray.hits_in_interval);
    hits += int(ray.hits_in_interval);
    // The store of the last record goes out in the cycle in which its test ends, so it delays nothing.
    CHECK(done.last_completion == 1 + sum_of_records(s) + before_last + 1);
    Address line = 0;
    for (const mem::Request& request : l1.log()) {
      if (!request.write) continue;
      CHECK(request.line == line);
      CHECK(request.sectors == 1);
      line += 256;
    }
  }
  CHECK(hits > 20);
}

TEST_CASE(
    "a store that is the last thing of a ray keeps its warp for exactly the way of the acknowledgement") {
  pipeline::GpuParams gpu = preset("vulkan-sim-desktop");
  const Positions positions{{-1, -1, 5}, {1, -1, 5}, {0, 1, 5}};
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(positions), gpu.bvh);
  for (uint32_t way : {0, 1, 2, 50, 215}) {
    gpu.rt.shortcuts.store_latency = way;
    mem::FixedLatencyMemory l1(0);
    RtUnit unit(gpu.rt, {memory, l1});
    RayState ray = ray_of(top.address, {0, 0, 0}, {0, 0, 1});
    REQUIRE(begin(ray, memory));
    auto warps = one_lane(ray);
    const Launch done = launch(unit, l1, warps, way % 2);
    // The ray reads header, root, instance and header, root, descriptor and triangle; then comes the store.
    CHECK(done.last_completion == 1 + (5 + 9 + 11 + 5 + 9 + 4 + 9) + way + 1);
    CHECK(unit.stats().hit_writes.value() == 1);
  }
}

TEST_CASE("a procedural candidate takes 4 and 9 cycles and two stores") {
  const pipeline::GpuParams gpu = preset("vulkan-sim-desktop");
  const Scene scene(gpu.bvh, true);
  int candidates = 0;
  for (uint64_t seed = 1; seed < 30; ++seed) {
    mem::FixedLatencyMemory l1(0);
    RtUnit unit(gpu.rt, {scene.memory, l1, nullptr, 0, TableLayout{Address{1} << 30, 32}});
    CandidateTable table;
    table.row.resize(32);
    RayState ray = scene.ray(seed, 4);
    ray.table = &table;
    REQUIRE(begin(ray, scene.memory));
    WarpRays warp;
    warp[0] = ray;
    unit.submit(0, 0, 1, warp.data());
    Cycle now = 0;
    while (!unit.pop_completion(now)) unit.tick(++now);
    const RtStats& s = unit.stats();
    CHECK(s.hit_writes.value() == 2 * table.gathered);
    CHECK(s.table_writes.value() == 0);
    candidates += int(table.gathered);
    if (table.gathered == 0) CHECK(now == 1 + sum_of_records(s) + 1);
  }
  CHECK(candidates > 10);
}

TEST_CASE("32 rays that share nothing are bound by the port: a request a cycle") {
  const pipeline::GpuParams gpu = preset("vulkan-sim-desktop");
  const Scene scene(gpu.bvh);
  std::vector<WarpRays> warps(4);
  for (size_t w = 0; w < 4; ++w)
    for (size_t lane = 0; lane < kLanes; ++lane) warps[w][lane] = scene.ray(100 + w * kLanes + lane);
  std::vector<WarpRays> expected = warps;
  mem::FixedLatencyMemory l1(0);
  RtUnit unit(gpu.rt, {scene.memory, l1});
  const Launch done = launch(unit, l1, warps, false);
  const RtStats& s = unit.stats();
  const uint64_t sent = s.requests.value() + s.hit_writes.value();
  CHECK(s.cycles.count(Stall::NodeRequest) == sent);
  CHECK(done.last_completion >= sent);
  CHECK(double(done.last_completion) < 1.15 * double(sent));  // the tail, in which few rays are left
  CHECK(s.cycles.count(Stall::TestBusy) == 0);                // tests have no limit
  for (size_t w = 0; w < 4; ++w)
    for (size_t lane = 0; lane < kLanes; ++lane) {  // none of the shortcuts changes a hit
      run_to_end(expected[w][lane], scene.memory);
      CHECK(warps[w][lane].committed.t == expected[w][lane].committed.t);
      CHECK(warps[w][lane].committed.primitive == expected[w][lane].committed.primitive);
      CHECK(warps[w][lane].committed.instance == expected[w][lane].committed.instance);
    }
}

TEST_CASE("without the switches nothing but nodes is read and nothing stored") {
  pipeline::GpuParams gpu = preset("vulkan-sim-desktop");
  gpu.rt.shortcuts = {};
  const Scene scene(gpu.bvh);
  mem::FixedLatencyMemory l1(7);
  RtUnit unit(gpu.rt, {scene.memory, l1});
  auto warps = one_lane(scene.ray(3));
  const Launch done = launch(unit, l1, warps, true);
  const RtStats& s = unit.stats();
  CHECK(s.headers.value() + s.descriptors.value() + s.hit_writes.value() == 0);
  CHECK(s.requests.value() ==
        2 * (s.internal_nodes.value() + s.triangle_leaves.value()) + 4 * s.instance_leaves.value());
  // A node of 64 B takes two requests, and the second answer comes after 7 cycles.
  CHECK(done.last_completion == 1 + (s.internal_nodes.value() + s.triangle_leaves.value()) * (1 + 7 + 8) +
                                    s.instance_leaves.value() * (3 + 7 + 8) + 1);
}

}  // namespace
}  // namespace glint::rt::test
