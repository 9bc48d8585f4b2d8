// Tests that latency by stage adds up to latency by class, is the same for every way of running, and follows
// the code.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "isa/op_row.h"
#include "isa/text.h"
#include "pipeline/run_profile.h"
#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

using namespace glint;

namespace {

constexpr size_t kNumClasses = size_t(isa::Class::Count);
using ByClass = std::array<uint64_t, kNumClasses>;

struct Core {
  std::array<ByClass, core::kNumStages> stage{};
  ByClass all{};
  bool operator==(const Core&) const = default;
};

struct Latencies {
  Cycle cycles = 0;
  std::vector<Core> cores;
  ProfileTable profile;
};

// Runs path tracing of procedural spheres: ray generation, intersection, closest hit and miss.
Latencies run(uint32_t threads, bool no_skip, bool profile = false) {
  const pipeline::RenderJob job = test::small_job("WKND", pipeline::Workload::PathTracing, 16, 1);
  pipeline::SceneWorld scene(job);
  pipeline::HostOptions host;
  host.threads = threads;
  pipeline::TimingMachine machine(job.gpu, scene.world, no_skip, host);
  pipeline::observe(machine, {.profile = profile});
  Latencies out;
  out.cycles = machine.run({});
  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    const core::CoreStats& stats = machine.core(i).stats();
    Core& one = out.cores.emplace_back();
    for (size_t k = 0; k < kNumClasses; ++k) {
      one.all[k] = stats.latency.count(isa::Class(k));
      for (size_t s = 0; s < one.stage.size(); ++s)
        one.stage[s][k] = stats.stage[s]->latency.count(isa::Class(k));
    }
  }
  if (profile) out.profile = pipeline::profile_of(machine, *scene.world.image);
  return out;
}

uint64_t of_stage(const Latencies& run, isa::Stage stage, isa::Class klass) {
  uint64_t sum = 0;
  for (const Core& core : run.cores) sum += core.stage[size_t(stage)][size_t(klass)];
  return sum;
}

}  // namespace

TEST_CASE("latencies of all stages add up to latency by class, on one thread or two, stepping or skipping") {
  const Latencies plain = run(1, false);
  for (const auto& [threads, no_skip] :
       {std::pair(1u, false), std::pair(2u, false), std::pair(1u, true), std::pair(2u, true)}) {
    CAPTURE(threads, no_skip);
    const Latencies other = run(threads, no_skip);
    CHECK(other.cycles == plain.cycles);
    CHECK(other.cores == plain.cores);
    for (const Core& core : other.cores)
      for (size_t k = 0; k < kNumClasses; ++k) {
        uint64_t sum = 0;
        for (const ByClass& stage : core.stage) sum += stage[k];
        CHECK(sum == core.all[k]);
      }
  }
  for (const isa::Stage stage :
       {isa::Stage::RayGeneration, isa::Stage::Intersection, isa::Stage::ClosestHit, isa::Stage::Miss})
    CHECK(of_stage(plain, stage, isa::Class::Mem) > 0);
  for (const isa::Stage stage : {isa::Stage::AnyHit, isa::Stage::Callable, isa::Stage::Compute})
    CHECK(of_stage(plain, stage, isa::Class::Alu) == 0);
}

// The profile knows an instruction's stage from the program that it stands in. It times only accesses and
// traces; the others end a few cycles after their issue.
TEST_CASE(
    "what a stage's accesses and traces took is in the latency of that stage, though other stages run when "
    "they end") {
  constexpr uint64_t kMostFixed = 64;
  const Latencies watched = run(1, false, true);
  CHECK(watched.cores == run(1, false).cores);
  for (const isa::Class klass : {isa::Class::Mem, isa::Class::Tex, isa::Class::Rt})
    for (size_t s = 0; s < size_t(core::kNumStages); ++s) {
      const auto stage = isa::Stage(s);
      CAPTURE(name_of(klass), name_of(stage));
      uint64_t timed = 0, others = 0;
      for (const ProfileRow& row : watched.profile.rows) {
        if (row.stage != name_of(stage) || isa::op_table()[size_t(isa::find_op(row.op))].klass != klass)
          continue;
        timed += row.latency;
        others += row.issues - row.ended;
      }
      CHECK(of_stage(watched, stage, klass) >= timed);
      CHECK(of_stage(watched, stage, klass) <= timed + kMostFixed * others);
    }
  CHECK(of_stage(watched, isa::Stage::RayGeneration, isa::Class::Rt) > 100'000);
}
