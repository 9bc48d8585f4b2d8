// Tests that every registered entry keeps the promises of rtunit/ray_entry.h.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/registry.h"
#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"
#include "tests/support/rt_trace.h"
#include "tests/support/stat_listing.h"

namespace glint::rt::test {
namespace {

// Begins each ray at one of the nodes learned so far, which is mostly wrong, and checks what it is told.
class Gambler final : public RayEntry {
 public:
  static constexpr std::string_view kName = "gambler";
  static constexpr std::string_view kDoc = "A ray begins anywhere.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Gambler(Params, Context) {}
  Timing timing() const override { return {7, 2, 1}; }
  bool wants_path() const override { return true; }
  bool wants(const Ray& ray) const override {
    REQUIRE((ray.flags & (ray_flag::kOpaque | ray_flag::kCullNoOpaque)) != 0);
    REQUIRE((ray.flags & ray_flag::kSkipAabbs) != 0);  // The scene has boxes.
    return true;
  }
  std::optional<Start> look_up(const RayState& ray) override {
    REQUIRE(ray.nodes_visited == 0);
    REQUIRE(open_.insert({ray.path, false}).second);
    if (known_.empty()) return std::nullopt;
    open_[ray.path] = true;
    Start out = known_[random_.below(uint32_t(known_.size()))];
    if (random_.below(8) == 0) out.instance_leaf = random_.bits();  // There is none.
    if (random_.below(8) == 0) out.node -= 1 << 20;
    return out;
  }
  std::optional<Start> learn(const RayState& ray, const Hit& hit) override {
    REQUIRE(open_.contains(ray.path));
    REQUIRE(hit.valid());
    const auto start = start_above(ray, hit, random_.below(6));
    REQUIRE((start.has_value() && start->instance_leaf == hit.instance_leaf));
    known_.push_back(*start);
    return start;
  }
  void ended(const RayState& ray, const Ending& ending) override {
    REQUIRE(open_.contains(ray.path));
    REQUIRE(open_[ray.path] == ending.was_predicted);
    REQUIRE((ending.was_predicted || !ending.was_verified));
    if (ending.was_verified) REQUIRE(ray.committed.valid());
    open_.erase(ray.path);
  }

 private:
  Random random_{77};
  std::vector<Start> known_;
  // Has the rays that were looked up and have not ended, by their paths, which go with them (rt.pool).
  std::map<const RayPath*, bool> open_;
};
const Register<RayEntry, Gambler> registered;

// Makes warps of rays that come from few places in few directions.
std::vector<WarpRays> rays_of(const BuiltScene& scene,
                              std::vector<std::array<CandidateTable, kLanes>>* tables) {
  Random random{5};
  std::vector<WarpRays> out(12);
  for (size_t w = 0; w < out.size(); ++w)
    for (size_t lane = 0; lane < kLanes; ++lane) {
      Random like{1 + random.below(40)};
      RayState state = ray_of(scene.top.address, like.point(12), like.point(1));
      state.ray.flags = std::array{0u, 5u, 0x205u, 0x205u, 0x205u, 0x201u, 0x284u, 0x204u}[random.below(8)];
      state.ray.origin[0] += random.uniform(-0.1f, 0.1f);
      state.rules.end_at_first_hit = false;
      if (tables) {
        (*tables)[w][lane].row.resize(3);
        state.table = &(*tables)[w][lane];
      }
      REQUIRE(begin(state, scene.memory));
      out[w][lane] = state;
    }
  return out;
}

Traced trace(const BuiltScene& scene, const Params& params, bool gather, bool every_cycle) {
  std::vector<std::array<CandidateTable, kLanes>> tables(12);
  return trace_rays(params, scene.memory, rays_of(scene, gather ? &tables : nullptr),
                    mem::FixedLatencyMemory(30, 2), every_cycle, gather ? 3 : 0);
}

TEST_CASE("an entry changes no hit, and skipping to events changes no cycle and no count") {
  uint64_t predicted = 0, verified = 0, wrong = 0, hits = 0, restarts = 0, spills = 0, moves = 0;
  uint32_t number = 0;
  const auto names = Registry<RayEntry>::names();
  REQUIRE(names.size() >= 3);
  const auto prefetchers = Registry<Prefetcher>::names(), mappings = Registry<WorkMapping>::names();
  for (const std::string& format : Registry<NodeFormat>::names()) {
    const Scene scene = crowd(40 + number, 60);
    const BuiltScene built(scene, format);
    std::vector<WarpRays> expected = rays_of(built, nullptr);
    for (WarpRays& warp : expected)
      for (RayState& ray : warp) run_to_end(ray, built.memory);
    for (const std::string& name : names)
      for (const std::string& stack : Registry<StackModel>::names())
        for (const bool gather : {false, true}) {
          Params params;
          params.entry.name = name;
          params.stack.name = stack;
          params.retest = number % 3 != 0;
          params.warps = 1 + number % 4;
          params.mshr_entries = std::array{0u, 3u}[number % 2];
          params.shortcuts.fetch_headers = params.shortcuts.fetch_descriptors = number % 5 == 0;
          params.prefetch.name = prefetchers[number % prefetchers.size()];
          params.mapping.name = mappings[number / 2 % mappings.size()];
          ++number;
          if (!RtUnit::why_not_together(params).empty()) params.mapping.name = WorkMapping::kOwnRay;
          CAPTURE(format, name, stack, gather, number, params.prefetch.name, params.mapping.name);
          const Traced a = trace(built, params, gather, true), b = trace(built, params, gather, false);
          REQUIRE(a.completion == b.completion);
          CHECK(glint::test::first_difference(a.stats, b.stats) == "");
          require_same_hits(a.rays, expected);
          hits += num_hits(expected);
          CHECK((a.count("looked_up") != 0) == (name != RayEntry::kRoot));
          CHECK(a.count("verified") + a.count("wrong") <= a.count("predicted"));
          predicted += a.count("predicted");
          verified += a.count("verified");
          wrong += a.count("wrong");
          restarts += a.count("restarts");
          moves += a.count("moves");
          spills += a.count("stack_spills");
        }
  }
  // Each mechanism must have been at work.
  for (const uint64_t seen : {predicted, verified, wrong, hits, restarts, spills, moves}) CHECK(seen > 100);
}

TEST_CASE(
    "rays that end at the first hit still hit something if and only if they would without a prediction") {
  const Scene scene = crowd(9, 60);
  const BuiltScene built(scene, "bvh6");
  for (const std::string& name : Registry<RayEntry>::names()) {
    CAPTURE(name);
    Params params;
    params.entry.name = name;
    std::vector<WarpRays> rays = rays_of(built, nullptr), expected = rays;
    for (size_t w = 0; w < rays.size(); ++w)
      for (size_t lane = 0; lane < kLanes; ++lane) {
        rays[w][lane].rules.end_at_first_hit = expected[w][lane].rules.end_at_first_hit = true;
        run_to_end(expected[w][lane], built.memory);
      }
    mem::FixedLatencyMemory l1(30, 2);
    RtUnit unit(params, {built.memory, l1, nullptr, 0, {}, Address{1} << 32});
    launch(unit, l1, rays, false);
    uint64_t hits = 0;
    for (size_t w = 0; w < rays.size(); ++w)
      for (size_t lane = 0; lane < kLanes; ++lane) {
        REQUIRE(rays[w][lane].committed.valid() == expected[w][lane].committed.valid());
        hits += rays[w][lane].committed.valid();
      }
    CHECK(hits > 50);
  }
}

}  // namespace
}  // namespace glint::rt::test
