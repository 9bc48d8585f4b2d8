// Tests the timing machine: nothing is lost, every cycle has a reason, and skipping idle time changes
// nothing.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"
#include "tests/support/stat_listing.h"

using namespace glint;

TEST_CASE("every cycle of every core, RT unit and partition is given to exactly one reason") {
  const pipeline::RenderJob job = test::small_job("WKND", pipeline::Workload::PathTracing, 16, 1);
  pipeline::SceneWorld scene(job);
  pipeline::TimingMachine machine(job.gpu, scene.world, false);

  machine.run({});
  const Cycle cycles = machine.attributed_cycles();

  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    CHECK(machine.core(i).stats().stalls.total() == cycles * job.gpu.core.schedulers);
    CHECK(machine.rt_unit(i).stats().cycles.total() == cycles);
  }
  for (uint32_t i = 0; i < machine.memory().num_partitions(); ++i)
    CHECK(machine.memory().partition(i).stats().cycles.total() == cycles);
}

TEST_CASE("rays that enter the RT units leave them") {
  const pipeline::RenderJob job = test::small_job("WKND", pipeline::Workload::Shadow, 16, 1);
  pipeline::SceneWorld scene(job);
  pipeline::TimingMachine machine(job.gpu, scene.world, false);

  machine.run({});

  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    const rt::RtStats& stats = machine.rt_unit(i).stats();
    CHECK(stats.rays.value() + stats.resumed.value() == stats.finished.value() + stats.suspended.value());
  }
}

TEST_CASE(
    "each ray is in the spreads of nodes and times once, also those that a shader is the last to have") {
  const pipeline::RenderJob job = test::small_job("WKND", pipeline::Workload::PathTracing, 8, 1);
  pipeline::SceneWorld scene(job);
  pipeline::TimingMachine machine(job.gpu, scene.world, false);

  machine.run({});

  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    const rt::RtStats& stats = machine.rt_unit(i).stats();
    REQUIRE(stats.finished.value() < stats.rays.value());
    CHECK(stats.ray_nodes.total() == stats.rays.value());
    CHECK(stats.ray_latency.total() == stats.rays.value());
    CHECK(stats.most_nodes >= stats.nodes_per_ray.value());
  }
}

TEST_CASE("skipping idle time changes no number of the whole machine") {
  const auto workload = GENERATE(pipeline::Workload::PathTracing, pipeline::Workload::AmbientOcclusion);
  const pipeline::RenderJob job = test::small_job("WKND", workload, 8, 1);
  pipeline::SceneWorld first(job), second(job);
  pipeline::TimingMachine skipping(job.gpu, first.world, false), stepping(job.gpu, second.world, true);

  CHECK(skipping.run({}) == stepping.run({}));

  CHECK(test::first_difference(test::listing(skipping.root()), test::listing(stepping.root())) == "");
}
