// Tests the RT unit's cycles exactly: fetch, test and hand-over latencies, port and pipeline limits, merging.
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/catch.h"
#include "tests/support/rt_launch.h"

namespace glint::rt::test {
namespace {

struct Scene {
  mem::AddressSpace memory;
  Positions positions;
  StructureInfo top;
  explicit Scene(uint32_t count = 500) {
    Random random{9};
    positions = soup(random, count, 10, 2);
    top = single(memory, triangles(positions), {"bvh6", false});
  }
  RayState ray(uint64_t seed) const {
    Random random{seed};
    RayState state = ray_of(top.address, random.point(12), random.point(1), 0, 100);
    REQUIRE(begin(state, memory));
    return state;
  }
};

TEST_CASE("a lone ray takes its fetches and tests in sequence, and two cycles to enter and leave") {
  const Scene scene;
  for (uint64_t seed = 1; seed < 20; ++seed) {
    Params params;
    params.request_bytes = seed % 2 ? 64 : 32;
    params.responses_per_cycle = 4;
    params.stack.name = "full";
    const Cycle latency = 3 * seed;
    mem::FixedLatencyMemory l1(latency);
    RtUnit unit(params, {scene.memory, l1});
    auto warps = one_lane(scene.ray(seed));
    const Launch done = launch(unit, l1, warps, false);
    const RtStats& s = unit.stats();
    REQUIRE(s.internal_nodes.value() > 2);
    // A node's requests leave one per cycle, and the last answer counts.
    const Cycle extra = 64 / params.request_bytes - 1, extra_instance = 128 / params.request_bytes - 1;
    const Cycle expected = 1 + s.internal_nodes.value() * (latency + extra + params.box.latency) +
                           s.triangle_leaves.value() * (latency + extra + params.triangle.latency) +
                           s.instance_leaves.value() * (latency + extra_instance + params.transform.latency) +
                           1;
    CHECK(done.last_completion == expected);
    CHECK(s.requests.value() == (s.internal_nodes.value() + s.triangle_leaves.value()) * (extra + 1) +
                                    s.instance_leaves.value() * (extra_instance + 1));
    CHECK(s.warp_latency_sum.value() == expected);
    CHECK(s.cycles.count(Stall::NodeRequest) == s.requests.value());
    CHECK(s.cycles.count(Stall::WaitingMemory) == s.fetches.value() * (latency - 1));
  }
}

TEST_CASE("with an oracle that has every node in the L1, a ray waits for hits and sends no request") {
  const Scene scene;
  for (uint64_t seed = 1; seed < 20; ++seed) {
    Params params;
    params.stack.name = "full";
    mem::FixedLatencyMemory fast(1), slow(500), unused(500);
    RtUnit at_once(params, {scene.memory, fast}), late(params, {scene.memory, slow});
    params.oracle.fetch_hits = true;
    RtUnit sure(params, {scene.memory, unused});
    auto a = one_lane(scene.ray(seed)), b = a, c = a;
    const Cycle hits = launch(at_once, fast, a, false).last_completion;
    CHECK(launch(sure, unused, b, false).last_completion == hits);
    CHECK(launch(late, slow, c, false).last_completion > hits);
    CHECK(unused.log().empty());
    CHECK(sure.stats().requests.value() == at_once.stats().requests.value());
  }
}

TEST_CASE("lanes with the same ray share every fetch") {
  const Scene scene;
  const RayState ray = scene.ray(3);
  Params params;
  params.box.units = params.triangle.units = params.transform.units = 32;
  mem::FixedLatencyMemory l1(20);
  RtUnit one(params, {scene.memory, l1}), all(params, {scene.memory, l1});
  auto a = one_lane(ray);
  std::vector<WarpRays> b(1);
  b[0].fill(ray);
  const Launch alone = launch(one, l1, a, false);
  const Launch together = launch(all, l1, b, false);
  CHECK(all.stats().fetches.value() == one.stats().fetches.value());
  CHECK(all.stats().merged_lanes.value() == 31 * one.stats().fetches.value());
  CHECK(together.last_completion == alone.last_completion);
}

TEST_CASE("a test pipeline starts no more tests than its units and interval allow") {
  const Scene scene;
  std::vector<WarpRays> warps(1);
  warps[0].fill(scene.ray(3));
  Params params;
  params.box = {10, 4, 2};  // two tests in four cycles: 32 lanes take 15 more intervals
  params.triangle.units = params.transform.units = 32;
  params.triangle.interval = 1;
  mem::FixedLatencyMemory l1(20);
  RtUnit unit(params, {scene.memory, l1});
  // The first node of all lanes is the root, and its last test starts 15 * 4 cycles after its first.
  std::vector<Cycle> starts;
  unit.node_visited().listen([&](const NodeVisited& visit) {
    if (visit.node.address == scene.top.address + 64) starts.push_back(visit.cycle);
  });
  launch(unit, l1, warps, false);
  REQUIRE(starts.size() == 32);
  CHECK(starts.front() == 21);
  for (size_t i = 0; i < 32; ++i) CHECK(starts[i] == 21 + 4 * (i / 2));
  CHECK(unit.stats().cycles.count(Stall::TestBusy) > 0);
}

TEST_CASE("the request port sends one request a cycle, more when it has more ports") {
  const Scene scene;
  std::vector<WarpRays> warps(4);
  for (size_t w = 0; w < 4; ++w)
    for (size_t lane = 0; lane < kLanes; ++lane) warps[w][lane] = scene.ray(100 + w * kLanes + lane);
  Cycle previous = kNever;
  for (uint32_t ports : {1, 2, 4}) {
    Params params;
    params.requests_per_cycle = params.responses_per_cycle = ports;
    params.box.units = params.triangle.units = 64;
    params.triangle.interval = 1;
    auto rays = warps;
    mem::FixedLatencyMemory l1(1);
    RtUnit unit(params, {scene.memory, l1});
    const Launch done = launch(unit, l1, rays, false);
    CHECK(done.last_completion >= unit.stats().requests.value() / ports);
    CHECK(done.last_completion < previous);
    previous = done.last_completion;
  }
}

TEST_CASE("as many answers are taken a cycle as the unit has ports for them") {
  const Scene scene;
  for (uint32_t ports : {1u, 2u, 3u}) {
    std::vector<WarpRays> warps(1);
    for (size_t lane = 0; lane < 6; ++lane) warps[0][lane] = scene.ray(3);
    Params params;
    params.coalescing.name = "each_lane";
    params.requests_per_cycle = 8;
    params.responses_per_cycle = ports;
    params.box.units = 32;
    mem::FixedLatencyMemory l1(20);
    RtUnit unit(params, {scene.memory, l1});
    std::vector<Cycle> starts;  // of the root's tests
    unit.node_visited().listen([&](const NodeVisited& visit) {
      if (visit.node.address == scene.top.address + 64) starts.push_back(visit.cycle);
    });
    launch(unit, l1, warps, false);
    REQUIRE(starts.size() == 6);
    for (size_t i = 0; i < 6; ++i) CHECK(starts[i] == 21 + i / ports);
  }
}

TEST_CASE("the buffer holds as many warps as it says, and as many are given back a cycle as it says") {
  const Scene scene;
  for (uint32_t retires : {1u, 2u}) {
    std::vector<WarpRays> warps(4);
    for (WarpRays& warp : warps) warp[0] = scene.ray(3);
    Params params;
    params.coalescing.name = "across_warps";  // all four go in step
    params.warps = 4;
    params.retires_per_cycle = retires;
    params.box.units = params.triangle.units = params.transform.units = 32;
    mem::FixedLatencyMemory l1(20);
    RtUnit unit(params, {scene.memory, l1});
    for (uint32_t w = 0; w < 4; ++w) {
      REQUIRE(unit.can_accept());
      unit.submit(0, w, 1, warps[w].data());
    }
    CHECK_FALSE(unit.can_accept());
    std::vector<Cycle> ends;
    for (Cycle now = 1; ends.size() < 4; ++now) {
      REQUIRE(now < 100'000);
      unit.tick(now);
      while (unit.pop_completion(now)) ends.push_back(now);
    }
    for (size_t i = 0; i < 4; ++i) CHECK(ends[i] == ends[0] + i / retires);
    CHECK(unit.can_accept());
  }
}

TEST_CASE("a leaf of two triangles takes two starts of the pipeline, one of one takes one") {
  const auto last = [](bool pair) {
    mem::AddressSpace memory;
    Positions positions{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}};
    if (pair) positions.insert(positions.end(), {{-1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
    const StructureInfo top = single(memory, triangles(positions), {"bvh6", true});
    RayState ray = ray_of(top.address, {0.5f, 0.2f, -5}, {0, 0, 1}, 0, 100);
    REQUIRE(begin(ray, memory));
    auto warps = one_lane(ray);
    Params params;
    params.triangle = {37, 3, 1};
    params.stack.name = "full";
    mem::FixedLatencyMemory l1(20);
    RtUnit unit(params, {memory, l1});
    const Launch done = launch(unit, l1, warps, false);
    REQUIRE(unit.stats().triangle_leaves.value() == 1);
    return done.last_completion;
  };
  CHECK(last(true) == last(false) + 3);
}

TEST_CASE("a refused request is tried again until it is taken, and the cycles are counted") {
  const Scene scene;
  class Stubborn final : public mem::L1Port {  // takes a request in every eighth cycle only
   public:
    Stubborn() { share_answers(inner); }
    bool access(Cycle now, mem::Client client, const mem::Request& r) override {
      return now % 8 == 0 && inner.access(now, client, r);
    }
    mem::Token take_answer(mem::Client client) override { return inner.take_answer(client); }
    void tick(Cycle) override {}
    Cycle next_event(Cycle now) const override { return inner.next_event(now); }
    uint32_t line_bytes() const override { return 128; }
    Cycle hit_latency() const override { return 1; }
    mem::FixedLatencyMemory inner{5};
  } l1;
  RtUnit unit({}, {scene.memory, l1});
  WarpRays warp;
  warp[0] = scene.ray(3);
  RayState expected = warp[0];
  run(expected, scene.memory);
  unit.submit(0, 7, 1, warp.data());
  Cycle now = 0;
  while (!unit.pop_completion(now)) unit.tick(++now);
  CHECK(warp[0].committed.t == expected.committed.t);
  CHECK(unit.stats().refusals.value() == unit.stats().cycles.count(Stall::L1Refused));
  CHECK(unit.stats().refusals.value() >= unit.stats().requests.value());
  CHECK(unit.stats().cycles.total() == now + 1);  // cycle 0 included
}

TEST_CASE("results are stored as 32 bytes per ray, one request per line, before the warp returns") {
  const Scene scene;
  std::vector<WarpRays> warps(1);
  for (size_t lane = 0; lane < kLanes; ++lane) warps[0][lane] = scene.ray(200 + lane);
  Params params;
  params.result_store = true;
  mem::FixedLatencyMemory l1(5);
  RtUnit unit(params, {scene.memory, l1, nullptr, Address{1} << 30});
  launch(unit, l1, warps, false);
  CHECK(unit.stats().result_writes.value() == 8);
  std::vector<Address> lines;
  for (const mem::Request& r : l1.log())
    if (r.write) {
      lines.push_back(r.line);
      CHECK(r.sectors == 0xf);
    }
  REQUIRE(lines.size() == 8);
  for (size_t i = 0; i < 8; ++i) CHECK(lines[i] == (Address{1} << 30) + 128 * i);
}

TEST_CASE("an idle unit has no next event") {
  const Scene scene;
  mem::FixedLatencyMemory l1(5);
  RtUnit unit({}, {scene.memory, l1});
  CHECK(unit.next_event(0) == kNever);
  unit.tick(100);
  unit.finish(101);
  CHECK(unit.stats().cycles.count(Stall::Idle) == 101);
}

}  // namespace
}  // namespace glint::rt::test
