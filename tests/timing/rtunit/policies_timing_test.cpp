// Tests the cycles of the RT unit's policies exactly: reads, stacks that leave the chip, restarts, sharing.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "memsys/memory_system.h"
#include "rtunit/unit/shared_stack_port.h"
#include "tests/support/catch.h"
#include "tests/support/rt_launch.h"
#include "tests/support/stat_listing.h"

namespace glint::rt::test {
namespace {

// Holds triangles that overlap so much that stacks grow deep.
struct Thicket {
  mem::AddressSpace memory;
  Positions positions;
  StructureInfo top;
  Thicket() {
    Random random{9};
    positions = soup(random, 400, 6, 6);
    top = single(memory, triangles(positions), {"bvh6", false});
  }
  RayState ray(uint64_t seed) const {
    Random random{seed};
    RayState state = ray_of(top.address, random.point(12), random.point(1), 0, 100);
    REQUIRE(begin(state, memory));
    return state;
  }
};

// Remembers when each request was taken.
class TimedMemory final : public mem::L1Port {
 public:
  explicit TimedMemory(Cycle latency) : inner(latency) { share_answers(inner); }
  bool access(Cycle now, mem::Client client, const mem::Request& r) override {
    sent.push_back(now);
    most_open = std::max(most_open, open += !r.write);
    return inner.access(now, client, r);
  }
  mem::Token take_answer(mem::Client client) override {
    --open;
    return inner.take_answer(client);
  }
  void tick(Cycle) override {}
  Cycle next_event(Cycle now) const override { return inner.next_event(now); }
  uint32_t line_bytes() const override { return 128; }
  Cycle hit_latency() const override { return inner.hit_latency(); }
  mem::FixedLatencyMemory inner;
  std::vector<Cycle> sent;
  int open = 0, most_open = 0;
};

Params plain() {
  Params params;
  params.stack.name = "full";
  params.mshr_entries = 0;
  params.responses_per_cycle = 64;
  return params;
}

// Returns the cycles of a lone ray: its nodes one after the other, one cycle to enter and one to leave.
Cycle time_of(const RtStats& s, const Params& p, Cycle latency) {
  return 2 + s.internal_nodes.value() * (latency + p.box.latency) +
         s.triangle_leaves.value() * (latency + p.triangle.latency) +
         s.instance_leaves.value() * (latency + 1 + p.transform.latency);
}

struct LoneRun {
  Cycle cycles = 0;
  explicit LoneRun(const Thicket& scene, const Params& params, uint64_t seed, Cycle latency)
      : l1(latency), unit(params, {scene.memory, l1, nullptr, 0, {}, Address{1} << 32}), warps(1) {
    warps[0][5] = scene.ray(seed);
    cycles = launch(unit, l1, warps, false).last_completion;
  }
  mem::FixedLatencyMemory l1;
  RtUnit unit;
  std::vector<WarpRays> warps;
};

TEST_CASE(
    "no more reads wait for the L1 than there are entries, and the next leaves in the cycle that one is "
    "free") {
  const Thicket scene;
  for (const uint32_t entries : {1u, 4u, 19u}) {
    Params params = plain();
    params.mshr_entries = entries;
    params.coalescing.name = "each_lane";
    params.box.latency = 1000;  // nobody wants a second node before all have their first
    TimedMemory l1(20);
    RtUnit unit(params, {scene.memory, l1});
    WarpRays warp;
    warp.fill(scene.ray(3));  // all 32 want the root
    unit.submit(0, 0, kAllLanes, warp.data());
    for (Cycle now = 0; now < 20 * 32 + 2; ++now) unit.tick(now);
    CHECK(l1.most_open == int(entries));
    REQUIRE(l1.sent.size() == 32);
    for (size_t i = 0; i < 32; ++i) CHECK(l1.sent[i] == 1 + i / entries * 20 + i % entries);
    CHECK(unit.stats().cycles.count(Stall::MshrFull) == 31 / entries * (20 - entries));
  }
}

TEST_CASE("a spill costs the port a cycle and a fill the L1's latency") {
  const Thicket scene;
  uint64_t spills = 0;
  for (uint64_t seed = 1; seed < 12; ++seed) {
    const Cycle latency = 5 + seed;
    Params params = plain();
    params.stack.name = "short_stack";
    const LoneRun run(scene, params, seed, latency);
    const RtStats& s = run.unit.stats();
    CHECK(s.stack_spills.value() == s.stack_fills.value());
    CHECK(run.cycles ==
          time_of(s, params, latency) + s.stack_spills.value() + s.stack_fills.value() * latency);
    uint64_t sectors = 0;
    for (const mem::Request& request : run.l1.log())
      if (request.traffic == mem::Traffic::RtStack) {
        ++sectors;
        CHECK(request.line >= Address{1} << 32);
        CHECK(std::popcount(request.sectors) == 1);
      }
    CHECK(sectors == s.stack_spills.value() + s.stack_fills.value());
    spills += s.stack_spills.value();
  }
  CHECK(spills > 10);
}

TEST_CASE("entries that come back from shared memory cost the cycle to their pass and the latency") {
  const Thicket scene;
  uint64_t loads = 0;
  for (uint64_t seed = 1; seed < 40; ++seed) {
    const Cycle latency = 5 + seed;
    Params params = plain();
    params.stack.name = "shared_memory";
    const LoneRun run(scene, params, seed, latency);
    const RtStats& s = run.unit.stats();
    const auto shared = [&](const char* name) {
      return glint::test::counter_in(glint::test::listing(s), name);
    };
    // All rows of a lane lie in the same banks.
    CHECK(shared("passes") == shared("stores") + shared("loads") + shared("spills"));
    CHECK(shared("stores") == shared("loads") + shared("spills"));
    CHECK(shared("spills") == s.stack_spills.value());
    CHECK(s.stack_spills.value() == s.stack_fills.value());
    if (s.stack_spills.value() > 0)
      continue;  // Whether those meet reads of nodes cannot be told from counts.
    CHECK(run.cycles == time_of(s, params, latency) + shared("loads") * (1 + 23));
    loads += shared("loads");
  }
  CHECK(loads > 10);
}

TEST_CASE("rows in the same banks go one after the other, and those in different banks together") {
  const SharedArea area{2, 1, 5, true};
  SharedStackPort port(area, nullptr);
  std::vector<std::pair<Cycle, int>> done;
  const auto run = [&](Cycle until) {
    for (Cycle now = 1; now <= until; ++now)
      port.run(now, [&](const SharedStackPort::Move& move) { done.emplace_back(now, int(move.lane)); });
  };
  const auto kind = SharedStackPort::Kind::Load;
  for (const int lane : {0, 1, 2, 3, 4, 8, 5}) port.ask({0, 0, uint8_t(lane), kind}, lane, 0);
  CHECK(port.has_loads());
  CHECK(port.next_event(0) == 1);
  run(8);
  // Lanes 0 to 3 pass in cycle 1, lane 4 in cycle 2 and lanes 8 and 5 in cycle 3.
  CHECK(done == std::vector<std::pair<Cycle, int>>{{6, 0}, {6, 1}, {6, 2}, {6, 3}, {7, 4}, {8, 8}, {8, 5}});
  CHECK_FALSE(port.has_loads());
  CHECK(port.next_event(8) == kNever);
}

TEST_CASE("a restart costs the visits from the root to the parent of what was forgotten") {
  const Thicket scene;
  uint64_t restarts = 0;
  for (uint64_t seed = 1; seed < 12; ++seed) {
    const Cycle latency = 5 + seed;
    Params params = plain();
    params.stack.name = "restart_trail";
    const LoneRun run(scene, params, seed, latency);
    const RtStats& s = run.unit.stats();
    // Each goes through the one instance to an internal node below it.
    const uint64_t instances = s.restarts.value(), nodes = s.restart_nodes.value() - instances;
    CHECK(nodes >= 2 * instances);
    CHECK(run.cycles == time_of(s, params, latency) + nodes * (latency + params.box.latency) +
                            instances * (latency + 1 + params.transform.latency));
    restarts += instances;
  }
  CHECK(restarts > 10);
}

TEST_CASE("lanes of two warps that want the same node share its fetch only across warps") {
  const Thicket scene;
  const auto fetches = [&](const char* coalescing, uint64_t& across) {
    Params params = plain();
    params.coalescing.name = coalescing;
    params.box.units = params.triangle.units = params.transform.units = 64;
    params.triangle.interval = 1;
    mem::FixedLatencyMemory l1(20);
    RtUnit unit(params, {scene.memory, l1});
    std::vector<WarpRays> warps(2);
    for (WarpRays& warp : warps) warp.fill(scene.ray(3));
    launch(unit, l1, warps, false);
    across = unit.stats().merged_across.value();
    return unit.stats().fetches.value();
  };
  uint64_t across = 0;
  const uint64_t shared = fetches("across_warps", across);
  CHECK(across == 32 * shared);
  CHECK(fetches("within_warp", across) == 2 * shared);
  CHECK(across == 0);
  CHECK(fetches("each_lane", across) == 64 * shared);
}

TEST_CASE("without a re-test a ray visits what lies behind its hit, and finds the same") {
  const Thicket scene;
  uint64_t stale = 0;
  for (uint64_t seed = 1; seed < 12; ++seed) {
    Params params = plain();
    const LoneRun with(scene, params, seed, 10);
    params.retest = false;
    const LoneRun without(scene, params, seed, 10);
    CHECK(with.unit.stats().stale_nodes.value() == 0);
    CHECK(without.unit.stats().nodes.value() ==
          with.unit.stats().nodes.value() + without.unit.stats().stale_nodes.value());
    CHECK(without.warps[0][5].committed.t == with.warps[0][5].committed.t);
    CHECK(without.cycles == time_of(without.unit.stats(), params, 10));
    stale += without.unit.stats().stale_nodes.value();
  }
  CHECK(stale > 10);
}

// Runs one ray on a real L1 and all behind it, cycle by cycle, and returns how long it was in the unit.
Cycle time_on(mem::MemorySystem& memory, RtUnit& unit, RayState ray, Cycle& now) {
  WarpRays warp;
  warp[0] = ray;
  const Cycle start = now, window = memory.shortest_latency();
  unit.submit(start, 0, 1, warp.data());
  Cycle done = kNever;
  while (done == kNever) {
    for (ChannelBase* channel : memory.channels()) channel->deliver();
    const Cycle from = now;
    for (; now < from + window; ++now) {
      memory.l1(0).tick(now);
      if (now == start) continue;
      unit.tick(now);
      if (unit.pop_completion(now)) done = now;
    }
    for (Cell* cell : memory.cells()) cell->advance(from, now);
  }
  return done - start;
}

TEST_CASE("a node that lies in the L1 comes after exactly the L1's hit latency") {
  const Thicket scene;
  for (const uint32_t hit_latency : {7u, 20u, 33u}) {
    mem::Params memory_params;
    memory_params.l1.hit_latency = hit_latency;
    stats::Group root(nullptr, "test");
    mem::MemorySystem memory(memory_params, 1, 1000, &root);
    Params params = plain();
    params.request_bytes = 128;
    RtUnit unit(params, {scene.memory, memory.l1(0)});
    Cycle now = 0;
    const Cycle first = time_on(memory, unit, scene.ray(3), now);
    const RtStats& s = unit.stats();
    const uint64_t internal = s.internal_nodes.value(), leaves = s.triangle_leaves.value(),
                   instances = s.instance_leaves.value();
    const Cycle second = time_on(memory, unit, scene.ray(3), now);
    REQUIRE(s.internal_nodes.value() == 2 * internal);
    CHECK(second == 2 + internal * (hit_latency + params.box.latency) +
                        leaves * (hit_latency + params.triangle.latency) +
                        instances * (hit_latency + params.transform.latency));
    CHECK(first > second);
  }
}

}  // namespace
}  // namespace glint::rt::test
