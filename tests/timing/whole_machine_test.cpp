// Tests that core mechanisms and layouts of threads change no picture, and that skipping and threads change
// no cycles.
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "exec/warp_layout.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

namespace glint::core {
namespace {

// Returns a frame whose edges cut tiles, of spheres and rays that scatter.
pipeline::RenderJob frame() {
  pipeline::RenderJob job = test::small_job("WKND", pipeline::Workload::PathTracing, 0, 1);
  job.frame.width = 27;
  job.frame.height = 18;
  job.gpu = test::preset("mobile");
  job.gpu.cores = 2;
  job.timing = true;
  job.threads = 1;
  return job;
}

// Turns on every mechanism of a core that the preset leaves off.
Params all_on(Params params) {
  params.issue = PolicyChoice<IssueScheduler>("cggty");
  params.block_interval = 1;
  params.grid_interval = 1.5;
  params.refill_latency = 7;
  params.lsu.merged_lines = 4;
  params.write_order = false;
  params.register_file = {2, 3};
  params.fetch = {false, 1024, 4, 2};
  params.constant = {false, 256, 2, 64, true};
  params.code_cache = {4096, 4, 78};
  params.lsu.war_latency = 11;
  params.lsu.shared_war_latency = 9;
  params.texture = {4, 5, true};
  return params;
}

}  // namespace

TEST_CASE("a picture is the same with every layout of threads, on both machines") {
  pipeline::RenderJob job = frame();
  const std::vector<float> picture = pipeline::render(job).rgba;
  for (const std::string& name : Registry<exec::WarpLayout>::names())
    for (const bool timing : {false, true}) {
      CAPTURE(name, timing);
      job.timing = timing;
      job.gpu.core.layout = PolicyChoice<exec::WarpLayout>(name.c_str());
      CHECK(pipeline::render(job).rgba == picture);
    }
}

TEST_CASE(
    "with every mechanism of a core on, a frame takes longer and is the same, stepped, skipped and on "
    "threads") {
  pipeline::RenderJob job = frame();
  const pipeline::RenderResult plain = pipeline::render(job);
  job.gpu.core = all_on(job.gpu.core);
  const pipeline::RenderResult costly = pipeline::render(job);
  CHECK(costly.rgba == plain.rgba);
  CHECK(costly.cycles > plain.cycles);
  job.threads = 2;
  CHECK(pipeline::render(job).cycles == costly.cycles);
  job.threads = 1;
  job.no_skip = true;
  CHECK(pipeline::render(job).cycles == costly.cycles);
}

TEST_CASE("stacks in shared memory take its room from the warps of a launch that traces rays") {
  pipeline::RenderJob job = frame();
  const pipeline::RenderResult plain = pipeline::render(job);
  job.gpu.rt.stack = PolicyChoice<rt::StackModel>("shared_memory");  // 2 KiB a warp
  job.gpu.core.shared_bytes = 7 * 2048 + 2047;
  const pipeline::RenderResult shared = pipeline::render(job);
  CHECK(plain.residency.warps > 7);
  CHECK(shared.residency.warps == 7);
  CHECK(name_of(shared.residency.limit) == "shared memory");
  CHECK(shared.rgba == plain.rgba);
  job.gpu.core.shared_bytes = 2047;
  job.gpu.rt.unit = "software";  // Its code keeps stacks in local memory.
  CHECK(pipeline::render(job).rgba == plain.rgba);
  job.gpu.rt.unit = "hardware";
  CHECK_THROWS_WITH(pipeline::render(job), Catch::Contains("a block needs 2048 bytes of shared memory"));
}

TEST_CASE("a timing run says what limits the warps of a core") {
  pipeline::RenderJob job = frame();
  const pipeline::RenderResult result = pipeline::render(job);
  CHECK(result.residency.warps < job.gpu.core.warps);
  CHECK(result.residency.limit == Residency::Limit::Registers);
  job.gpu.core.warps = 8;
  const pipeline::RenderResult fewer = pipeline::render(job);
  CHECK(fewer.residency.warps == 8);
  CHECK(fewer.residency.limit == Residency::Limit::Warps);
}

}  // namespace glint::core
