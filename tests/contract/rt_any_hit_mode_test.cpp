// Tests that every registered any-hit mode keeps the promises of rtunit/any_hit_mode.h.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>

#include "base/registry.h"
#include "rtunit/any_hit_mode.h"
#include "rtunit/traversal/traversal.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

// Holds a warp whose rays have gathered candidates for a few shaders. Their primitives tell the shaders.
struct Warp {
  std::array<RayState, kLanes> ray;
  std::array<CandidateTable, kLanes> table;
  LaneMask gathered = 0;

  Warp(Random& random, uint32_t rows, uint32_t shaders) {
    for (size_t lane = 0; lane < kLanes; ++lane) {
      table[lane].row.resize(rows);
      ray[lane].table = &table[lane];
      for (uint32_t n = random.below(rows + 1); n; --n) {
        Candidate candidate;
        candidate.hit.t = random.uniform(0, 10);
        candidate.hit.instance = 0;
        candidate.hit.primitive = random.below(shaders);
        candidate.is_procedural = random.below(2);
        table[lane].add(candidate);
      }
      if (table[lane].used == 0) continue;
      ray[lane].status = RayStatus::Gathered;
      gathered |= LaneMask{1} << lane;
    }
  }
  uint32_t left() const {
    uint32_t out = 0;
    for (const CandidateTable& t : table) out += uint32_t(std::popcount(t.used));
    return out;
  }
};

uint32_t shader_of(int, const Candidate& candidate) {
  return candidate.hit.primitive == 0 ? AnyHitMode::kNoShader : candidate.hit.primitive;
}

TEST_CASE(
    "every mode with a table presents one candidate of some lanes at a time until all tables are empty") {
  const auto names = Registry<AnyHitMode>::names();
  REQUIRE(names.size() >= 2);
  Random random{11};
  for (const std::string& name : names) {
    CAPTURE(name);
    const auto mode = Registry<AnyHitMode>::instance().entry(name).make_default({});
    CHECK(mode->table_rows() <= kMaxTableRows);
    if (mode->table_rows() == 0) continue;
    for (int trial = 0; trial < 200; ++trial) {
      Warp warp(random, mode->table_rows(), 1 + random.below(100));
      // These rays are of another trace, and not ours to present.
      const LaneMask others = warp.gathered & random.bits();
      const LaneMask ours = warp.gathered & ~others;
      uint32_t rounds = 0;
      for (LaneMask waiting = ours; waiting; ++rounds) {
        REQUIRE(rounds < mode->table_rows() * 101);
        const uint32_t before = warp.left();
        mode->present(warp.ray.data(), waiting, shader_of);
        LaneMask presented = 0;
        for_each_lane(waiting, [&](int lane) {
          RayState& state = warp.ray[size_t(lane)];
          if (state.status == RayStatus::Gathered) return;
          presented |= LaneMask{1} << lane;
          REQUIRE(state.status ==
                  (state.candidate_procedural ? RayStatus::NeedsIntersection : RayStatus::NeedsAnyHit));
          state.status = RayStatus::Gathered;
          if (state.table->used == 0) waiting &= ~(LaneMask{1} << lane);
        });
        REQUIRE(presented != 0);
        REQUIRE(before - warp.left() == uint32_t(std::popcount(presented)));
      }
      for_each_lane(others, [&](int lane) { REQUIRE(warp.ray[size_t(lane)].status == RayStatus::Gathered); });
    }
  }
}

TEST_CASE("the deferred mode runs one shader at a time, nearest candidates first") {
  const auto mode = Registry<AnyHitMode>::instance().entry("deferred").make_default({});
  Random random{12};
  for (int trial = 0; trial < 200; ++trial) {
    Warp warp(random, mode->table_rows(), 4);
    if (!warp.gathered) continue;
    const auto before = warp.table;
    mode->present(warp.ray.data(), warp.gathered, shader_of);
    uint32_t shader = AnyHitMode::kNoShader;
    std::array<uint32_t, 4> wanting{};
    for_each_lane(warp.gathered, [&](int lane) {
      const RayState& state = warp.ray[size_t(lane)];
      std::array<bool, 4> wants{};
      for (uint32_t rest = before[size_t(lane)].used; rest; rest &= rest - 1) {
        const Hit& hit = before[size_t(lane)].row[size_t(std::countr_zero(rest))].hit;
        wants[hit.primitive] = true;
        if (state.status != RayStatus::Gathered && hit.primitive == state.candidate.primitive)
          CHECK(state.candidate.t <= hit.t);
      }
      for (size_t s = 0; s < 4; ++s) wanting[s] += wants[s];
      if (state.status == RayStatus::Gathered || state.candidate.primitive == 0) return;
      if (shader == AnyHitMode::kNoShader) shader = state.candidate.primitive;
      CHECK(state.candidate.primitive == shader);
    });
    if (shader == AnyHitMode::kNoShader) continue;
    for (size_t s = 1; s < 4; ++s) CHECK(wanting[shader] >= wanting[s]);
  }
}

}  // namespace
}  // namespace glint::rt::test
