// Checks traces and shader calls by rays that were aimed at known points of a small structure, and by rays
// that pass through several triangles.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "rtunit/structure/build.h"
#include "rtunit/traversal/ray.h"
#include "tests/ops/op_lab.h"
#include "tests/ops/oracle.h"
#include "tests/ops/ray_pipeline.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

// Three triangles stand in the way of rays that fly along z. The first is tilted, and its box begins before
// the others, though it is met behind them. So a ray may take a farther hit before a nearer one.
constexpr double kLayers[2] = {4, 6};
double tilted_layer(double x) {
  return 5 + x / 2;
}
Address build_layers(mem::AddressSpace& memory) {
  std::vector<float> corners{-8, -8, 1, 8, -8, 9, 8, 8, 9};
  for (double z : kLayers)
    for (const auto& [x, y] : {std::pair{5, -7}, {8, -7}, {8, 3}})
      corners.insert(corners.end(), {float(x), float(y), float(z)});
  rt::BottomLevel level;
  rt::Geometry geometry;
  geometry.positions = std::as_bytes(std::span(corners));
  geometry.opaque = false;
  level.geometries.push_back(geometry);
  const std::vector<rt::StructureInfo> bottoms{rt::build_bottom(memory, "layers", level, {})};
  return rt::build_top(memory, "layers' top", std::vector<rt::Instance>{{}}, bottoms, {}).address;
}

std::vector<RayAsk> asks_of_layers(Address structure) {
  Random random{7};
  std::vector<RayAsk> out;
  for (size_t t = 0; t < kThreads; ++t) {
    RayAsk ask;
    ask.structure = structure, ask.mask = 0xff, ask.enabled = true;
    const double x = 6.75 + random.below(16) / 16.0;
    ask.aim.origin = {x, x - 9.5 - random.below(16) / 16.0, 0}, ask.aim.direction = {0, 0, 1};
    ask.aim.tmax = 20;
    ask.verdict = Verdict(random.below(3));
    if (random.below(4) == 0) ask.flags = rt::ray_flag::kTerminateOnFirstHit;
    out.push_back(ask);
  }
  return out;
}

// Returns true when the ray took a hit although a nearer one exists. `nearest` is World::nearest_first_hit.
bool check_layers_of(const RayAsk& ask, const std::vector<uint32_t>& log, bool nearest) {
  const auto word = [&](RayPayload::Word at) { return log[uint32_t(RayLog::kPayload) + at]; };
  const uint32_t runs = word(RayPayload::kAnyHits), last = word(RayPayload::kAnyHitSpecials),
                 hit = word(RayPayload::kSpecials);
  CHECK(log[RayLog::kTurns] == runs);
  if (ask.verdict == Verdict::Ignore) {
    CHECK(runs == 3);
    CHECK(real(ask.aim.tmax).is(hit));
    return false;
  }
  if (ask.verdict == Verdict::Accept && (ask.flags == 0 || nearest)) {
    CHECK(real(kLayers[0]).is(hit));
    return runs > 1;
  }
  // The first hit that is taken ends the ray, and it may be any.
  CHECK(runs == 1);
  CHECK(hit == last);
  const double layers[] = {kLayers[0], kLayers[1], tilted_layer(ask.aim.origin[0])};
  CHECK(std::any_of(std::begin(layers), std::end(layers), [&](double t) { return real(t).is(hit); }));
  return !real(kLayers[0]).is(hit);
}

void check_layers(const isa::OpRow& row, bool nearest) {
  INFO("rays that end at " << (nearest ? "the nearest" : "any") << " first hit");
  RayLab lab(ray_shaders(trace_text("call.sbt.hit")));
  lab.world.nearest_first_hit = nearest;
  const std::vector<RayAsk> asks = asks_of_layers(build_layers(lab.memory));
  fill_table(lab);
  ThreadWords inputs;
  for (const RayAsk& ask : asks) inputs.push_back(ask.words());
  const RayLab::Outcome outcome = lab.run(row, inputs);
  int farther[3] = {};
  for (size_t t = 0; t < kThreads; ++t) {
    INFO("thread " << t);
    farther[size_t(asks[t].verdict)] += check_layers_of(asks[t], outcome.log[t], nearest);
  }
  // Without such rays, an accepted candidate could not be told from one that ends the ray.
  CHECK(farther[size_t(Verdict::Accept)] > 0);
  CHECK(farther[size_t(Verdict::Terminate)] > 0);
}

}  // namespace

uint64_t check_ray_tracing(const isa::OpRow& row) {
  if (row.name.starts_with("ho.")) return check_hit_object(row);  // ho.execute has the effect of a trace
  RayLab lab(ray_shaders(trace_text("call.sbt.hit")));
  const RayScene scene(lab.memory, kLastSbtOffset);
  fill_table(lab);
  uint64_t lanes = 0;
  for (uint64_t seed : {1, 2, 3, 4, 5}) {
    const bool one_record = seed == 5;
    if (one_record) lab.world.table.hit.stride = lab.world.table.miss.stride = 0;
    ThreadWords inputs;
    std::vector<Expected> expected;
    for (RayAsk& ask : random_asks(scene, seed)) {
      ask.one_record = one_record;
      inputs.push_back(ask.words());
      expected.push_back(fresh_log());
      if (ask.enabled) expect_hit_shader(ask, follow(ask, expected.back()), expected.back());
    }
    const RayLab::Outcome outcome = lab.run(row, inputs);
    check_log(outcome.log, expected);
    lanes += outcome.lanes;
  }
  for (const bool nearest : {false, true}) check_layers(row, nearest);
  return lanes;
}

}  // namespace glint::test
