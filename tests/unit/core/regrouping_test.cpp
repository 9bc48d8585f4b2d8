// Tests that plans of regrouping bring equal keys together and move only what may move.
// SPDX-License-Identifier: Apache-2.0
#include "core/regrouping.h"

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "base/num_lanes.h"
#include "tests/support/catch.h"

namespace glint::core {
namespace {

// Holds warps of threads, each of which has a number of its own.
struct Warps {
  struct Lane {
    uint64_t key = 0;
    uint32_t thread = 0;
  };
  std::vector<Regrouping::Warp> warps;
  std::vector<std::array<uint64_t, kLanes>> keys;
  std::vector<std::array<Lane, kLanes>> lanes;

  Warps(uint32_t count, uint32_t num_keys, uint64_t seed) : warps(count), keys(count), lanes(count) {
    std::mt19937_64 random(seed);
    for (uint32_t w = 0; w < count; ++w) {
      Regrouping::Warp& warp = warps[w];
      warp.live = LaneMask(random() | random());
      warp.movable = LaneMask(random() | random() | random()) | ~warp.live;
      warp.running = warp.live & warp.movable & LaneMask(random() | random());
      for (size_t lane = 0; lane < size_t(kLanes); ++lane) {
        keys[w][lane] = random() % num_keys;
        lanes[w][lane] = {keys[w][lane], w * uint32_t(kLanes) + uint32_t(lane)};
      }
      warp.keys = keys[w].data();
    }
  }
  void apply(const Regrouping::Swap& swap) {
    REQUIRE(swap.warp_a != swap.warp_b);
    REQUIRE((warps[swap.warp_a].movable >> swap.lane_a & 1) == 1);
    REQUIRE((warps[swap.warp_b].movable >> swap.lane_b & 1) == 1);
    std::swap(lanes[swap.warp_a][swap.lane_a], lanes[swap.warp_b][swap.lane_b]);
    swap_bits(warps[swap.warp_a].running, swap.lane_a, warps[swap.warp_b].running, swap.lane_b);
    swap_bits(warps[swap.warp_a].live, swap.lane_a, warps[swap.warp_b].live, swap.lane_b);
  }
  // Returns the number of pairs of a warp and a key that a running thread of it has.
  size_t num_keys() const {
    std::set<std::pair<size_t, uint64_t>> seen;
    for (size_t w = 0; w < warps.size(); ++w)
      for_each_lane(warps[w].running, [&](int lane) { seen.insert({w, lanes[w][size_t(lane)].key}); });
    return seen.size();
  }
  uint32_t num_running() const {
    uint32_t count = 0;
    for (const Regrouping::Warp& warp : warps) count += num_lanes(warp.running);
    return count;
  }
};

}  // namespace

TEST_CASE(
    "a plan moves every thread once at most, only where it may, and no key is spread wider than needed") {
  Regrouping regrouping(64);
  uint32_t moved = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const bool compact = seed % 2 == 0;
    const uint32_t count = 1 + uint32_t(seed * 7 % 64), num_keys = 1 + uint32_t(seed % 11);
    CAPTURE(seed, compact, count, num_keys);
    Warps threads(count, num_keys, seed);
    const Warps before = threads;
    for (const Regrouping::Swap& swap : regrouping.plan(threads.warps, compact)) threads.apply(swap);
    CHECK(threads.num_running() == before.num_running());
    uint32_t travelled = 0, warps_in_use = 0;
    std::set<uint32_t> seen;
    for (uint32_t w = 0; w < count; ++w) {
      warps_in_use += threads.warps[w].running != 0;
      CHECK((compact || num_lanes(threads.warps[w].running) == num_lanes(before.warps[w].running)));
      for (size_t lane = 0; lane < size_t(kLanes); ++lane) {
        const uint32_t thread = threads.lanes[w][lane].thread;
        seen.insert(thread);
        travelled += (threads.warps[w].live >> lane & 1) && thread / kLanes != w;
        const bool stays = !(before.warps[w].movable >> lane & 1) || thread / kLanes == w;
        if (stays) CHECK(thread == w * kLanes + lane);
      }
    }
    CHECK(seen.size() == size_t{count} * kLanes);
    CHECK(regrouping.num_moved() == travelled);
    moved += travelled;
    // Sorted threads that are cut into warps have one key more for each cut that goes through a key.
    CHECK(threads.num_keys() <= num_keys + std::max(warps_in_use, 1u) - 1);
    if (before.num_running() == 0) CHECK(travelled == 0);
  }
  CHECK(moved > 10'000);
}

TEST_CASE("compacting fills warps, and without it each keeps its number of threads") {
  std::array<uint64_t, kLanes> keys{};
  const std::vector<Regrouping::Warp> warps{{0x0000'ffff, kAllLanes, kAllLanes, keys.data()},
                                            {0x0000'ffff, kAllLanes, 0x0000'ffff, keys.data()}};
  Regrouping regrouping(2);
  CHECK(regrouping.plan(warps, false).empty());
  // The first warp takes the 16 threads of the second, which gets 16 that wait.
  CHECK(regrouping.plan(warps, true).size() == 16);
  CHECK(regrouping.num_moved() == 32);
}

TEST_CASE("threads that have their keys in one warp already do not move") {
  std::array<uint64_t, kLanes> ones, twos;
  ones.fill(1), twos.fill(2);
  const std::vector<Regrouping::Warp> warps{{kAllLanes, kAllLanes, kAllLanes, twos.data()},
                                            {kAllLanes, kAllLanes, kAllLanes, ones.data()}};
  Regrouping regrouping(2);
  CHECK(regrouping.plan(warps, true).empty());
  CHECK(regrouping.num_moved() == 0);
}

}  // namespace glint::core
