// Tests that every registered leaf filter keeps the promises of rtunit/leaf_filter.h.
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "base/registry.h"
#include "rtunit/leaf_filter.h"
#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"
#include "tests/support/rt_trace.h"
#include "tests/support/stat_listing.h"

namespace glint::rt::test {
namespace {

constexpr uint32_t kTriangles = 300;

// Returns triangles that all need a shader, with maps that know some of the answers, or without maps.
Scene cut_out(const MicromapFormat* format) {
  Random random{31};
  Scene out;
  BottomScene& all = out.bottoms.emplace_back();
  all.add_triangles(soup(random, kTriangles, 10, 3), false);
  if (format) all.add_micromaps(maps_like_decide(random, kTriangles, *format));
  out.instances.resize(1);
  return out;
}

// Notes what a filter is asked, and asks it twice.
class Witness final : public LeafFilter {
 public:
  explicit Witness(const LeafFilter& filter) : filter_(filter) {}
  LeafAnswer look_up(const LeafQuestion& question) const override {
    const LeafAnswer answer = filter_.look_up(question);
    REQUIRE(answer == filter_.look_up(question));
    REQUIRE(answer.from % mem::kSectorBytes == 0);
    if (answer.opacity != Opacity::Unknown)
      REQUIRE((answer.opacity == Opacity::Opaque) == (question.candidate.primitive % 3 != 0));  // decide()
    ++asked;
    decided += answer.opacity != Opacity::Unknown;
    read += answer.from != 0;
    return answer;
  }
  mutable uint64_t asked = 0, decided = 0, read = 0;

 private:
  const LeafFilter& filter_;
};

std::vector<WarpRays> rays(const BuiltScene& built, const LeafFilter* filter, uint32_t flags) {
  Random random{5};
  std::vector<WarpRays> out(32);
  for (WarpRays& warp : out)
    for (RayState& state : warp) {
      state = ray_of(built.top.address, random.point(12), random.point(1), 0, INFINITY, flags);
      state.filter = filter;
      REQUIRE(begin(state, built.memory));
    }
  return out;
}

void run_all(std::vector<WarpRays>& warps, const mem::AddressSpace& memory) {
  for (WarpRays& warp : warps)
    for (RayState& state : warp) run_to_end(state, memory);
}

std::unique_ptr<LeafFilter> make(const std::string& name, const mem::AddressSpace& memory) {
  return Registry<LeafFilter>::instance().entry(name).make_default({nullptr, memory});
}

TEST_CASE("a filter says what the shader would say, or nothing, and no hit changes") {
  const MicromapFormat formats[] = {{false, 0}, {false, 3}, {false, 6}, {true, 0}, {true, 4}};
  REQUIRE(Registry<LeafFilter>::names().size() >= 2);
  for (const MicromapFormat& format : formats) {
    const Scene scene = cut_out(&format);
    for (const char* layout : {"depth_first", "treelet_cost"}) {
      const BuiltScene built(scene, BuildOptions{"bvh4", true, layout});
      for (const std::string& name : Registry<LeafFilter>::names()) {
        CAPTURE(name, format.two_states, format.level, layout);
        const auto filter = make(name, built.memory);
        const Witness witness(*filter);
        auto plain = rays(built, nullptr, 0), filtered = rays(built, &witness, 0);
        run_all(plain, built.memory);
        run_all(filtered, built.memory);
        require_same_hits(filtered, plain);
        CHECK(witness.asked > 100);
        CHECK((witness.decided > 50) == (name != LeafFilter::kNone));
        if (name != LeafFilter::kNone && format.two_states) CHECK(witness.decided == witness.asked);
      }
    }
  }
}

TEST_CASE("a filter is silent where a structure has no micromaps") {
  const BuiltScene built(cut_out(nullptr), "bvh6");
  for (const std::string& name : Registry<LeafFilter>::names()) {
    CAPTURE(name);
    const auto filter = make(name, built.memory);
    const Witness witness(*filter);
    auto filtered = rays(built, &witness, 0);
    run_all(filtered, built.memory);
    CHECK(witness.asked > 100);
    CHECK(witness.decided == 0);
    CHECK(witness.read == 0);
  }
}

TEST_CASE("nobody asks about what is forced to be opaque, and a shader sees what is forced not to be") {
  const MicromapFormat format{true, 2};
  const BuiltScene built(cut_out(&format), "bvh6");
  const auto filter = make("micromaps", built.memory);
  const Witness witness(*filter);
  for (const uint32_t flags : {ray_flag::kOpaque, ray_flag::kCullNoOpaque}) {
    auto forced = rays(built, &witness, flags);
    run_all(forced, built.memory);
    CHECK(witness.asked == 0);
  }
  uint64_t shaders = 0;
  for (WarpRays& warp : rays(built, &witness, ray_flag::kNoOpaque))
    for (RayState& state : warp)
      for (; state.status != RayStatus::Done; resolve(state)) {
        run(state, built.memory);
        if (state.status != RayStatus::NeedsAnyHit) continue;
        ++shaders;
        REQUIRE(state.candidate.primitive % 3 != 0);  // The filter has let the ray pass the others.
      }
  CHECK(shaders > 100);
}

TEST_CASE("a ray that wants two states needs no shader where maps have an opinion") {
  const MicromapFormat format{false, 2};
  const BuiltScene built(cut_out(&format), "bvh6");
  const auto filter = make("micromaps", built.memory);
  const auto shaders = [&](uint32_t flags) {
    uint64_t count = 0;
    for (WarpRays& warp : rays(built, filter.get(), flags))
      for (RayState& state : warp)
        for (; state.status != RayStatus::Done; resolve(state)) {
          run(state, built.memory);
          count += state.status == RayStatus::NeedsAnyHit;
        }
    return count;
  };
  CHECK(shaders(0) > 100);
  CHECK(shaders(ray_flag::kForceMicromaps2State) == 0);
}

TEST_CASE("in the unit a filter finds the same hits, is told of each look-up, and its reads take time") {
  const MicromapFormat format{false, 4};
  const BuiltScene built(cut_out(&format), "bvh6");
  for (const std::string& name : Registry<LeafFilter>::names()) {
    CAPTURE(name);
    Params params;
    params.leaf_filter.name = name;
    const auto filter = make(name, built.memory);
    const Witness witness(*filter);
    auto expected = rays(built, &witness, 0), ticked = rays(built, nullptr, 0), skipped = ticked;
    run_all(expected, built.memory);
    stats::Group root_ticked(nullptr, "unit"), root_skipped(nullptr, "unit");
    mem::FixedLatencyMemory l1_ticked(50, 1), l1_skipped(50, 1);
    RtUnit all(params, {built.memory, l1_ticked, &root_ticked}),
        some(params, {built.memory, l1_skipped, &root_skipped});
    const Launch a = launch(all, l1_ticked, ticked, true), b = launch(some, l1_skipped, skipped, false);
    all.finish(a.last_completion + 1);
    some.finish(b.last_completion + 1);
    CHECK(a.completion == b.completion);
    require_same_hits(ticked, expected);
    require_same_hits(skipped, expected);
    const std::string listed = glint::test::listing(root_ticked);
    CHECK(glint::test::first_difference(listed, glint::test::listing(root_skipped)) == "");
    if (name == LeafFilter::kNone) continue;
    // In the unit children are visited in another order, so that a few other triangles are met.
    const uint64_t asked = glint::test::counter_in(listed, "looked_up");
    CHECK(asked > witness.asked / 2);
    CHECK(glint::test::counter_in(listed, "opaque") + glint::test::counter_in(listed, "transparent") +
              glint::test::counter_in(listed, "unknown") ==
          asked);
    CHECK(glint::test::counter_in(listed, "bytes") ==
          glint::test::counter_in(listed, "reads") * mem::kSectorBytes);
    CHECK(glint::test::counter_in(listed, "reads") > 100);
  }
}

TEST_CASE("a filter is refused where instructions walk rays, with the reason") {
  for (const std::string& name : Registry<LeafFilter>::names()) {
    CAPTURE(name);
    Params params;
    params.leaf_filter.name = name;
    CHECK(RtUnit::why_not_together(params) == "");
    params.unit = kSoftware;
    const bool is_refused = RtUnit::why_not_together(params).find("ask no filter") != std::string::npos;
    CHECK(is_refused == (name != LeafFilter::kNone));
  }
}

// Returns the cycle in which a ray comes back that meets one triangle, whose map is transparent.
Cycle time_of(const char* filter, const Micromaps& maps, uint64_t& requests) {
  const Positions corners{{-9, -9, 5}, {9, -9, 5}, {0, 9, 5}};
  Geometry geometry = triangles(corners, false);
  geometry.micromaps = &maps;
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, geometry);
  RayState ray = ray_of(top.address, {0, 0, 0}, {0, 0, 1});
  REQUIRE(begin(ray, memory));
  auto warps = one_lane(ray);
  Params params;
  params.leaf_filter.name = filter;
  mem::FixedLatencyMemory l1(100, 1);
  RtUnit unit(params, {memory, l1});
  const Cycle end = launch(unit, l1, warps, false).last_completion;
  REQUIRE_FALSE(warps[0][5].committed.valid());  // decide() ignores primitive 0
  requests = l1.log().size();
  return end;
}

TEST_CASE("a state that lies in the leaf costs nothing, and one in a map the latency of memory") {
  const Micromaps uniform{{false, 3}, {Micromaps::uniform(MicroState::Transparent)}, {}};
  const Micromaps mapped{{false, 3}, {0}, std::vector<uint8_t>(16)};  // 64 states of value 0
  uint64_t plain_requests = 0, uniform_requests = 0, mapped_requests = 0;
  const Cycle plain = time_of("none", uniform, plain_requests),
              in_leaf = time_of("micromaps", uniform, uniform_requests),
              in_map = time_of("micromaps", mapped, mapped_requests);
  CHECK(in_leaf == plain);
  CHECK(in_map == plain + 100);
  CHECK(uniform_requests == plain_requests);
  CHECK(mapped_requests == plain_requests + 1);
}

}  // namespace
}  // namespace glint::rt::test
