// Tests that stepping, skipping and threads give the same machine under every preset and timing mechanism.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <functional>

#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"
#include "tests/support/stat_listing.h"

using namespace glint;
using pipeline::GpuParams;

namespace {

// Returns cycles and all statistics of a frame.
std::string run(const pipeline::RenderJob& job, bool no_skip, uint32_t threads) {
  pipeline::SceneWorld scene(job);
  pipeline::TimingMachine machine(job.gpu, scene.world, no_skip, {.threads = threads});
  const Cycle cycles = machine.run({});
  return fmt::format("cycles={}\n{}", cycles, test::listing(machine.root()));
}

void check_equal(const pipeline::RenderJob& job) {
  const std::string plain = run(job, false, 1);
  CHECK(test::first_difference(run(job, true, 1), plain) == "");
  CHECK(test::first_difference(run(job, false, 2), plain) == "");
}

// Returns frames of triangles in instances, and of boxes with intersection shaders.
std::vector<pipeline::RenderJob> frames(const GpuParams& gpu) {
  std::vector<pipeline::RenderJob> out{test::small_job("WKND", pipeline::Workload::PathTracing, 10, 1),
                                       test::small_job("SHIP", pipeline::Workload::Shadow, 12, 1)};
  for (pipeline::RenderJob& job : out) {
    const rt::BuildOptions bvh = job.gpu.bvh;
    job.gpu = gpu;
    job.gpu.bvh = bvh;
  }
  return out;
}

struct Mechanism {
  const char* name;
  std::function<void(GpuParams&)> turn_on;
};

const std::vector<Mechanism> kMechanisms = {
    {"a short stack of four entries",
     [](GpuParams& p) { p.rt.stack = PolicyChoice<rt::StackModel>("short_stack"); }},
    {"a restart trail", [](GpuParams& p) { p.rt.stack = PolicyChoice<rt::StackModel>("restart_trail"); }},
    {"fetches shared across warps",
     [](GpuParams& p) { p.rt.coalescing = PolicyChoice<rt::Coalescer>("across_warps"); }},
    {"fetches of each lane",
     [](GpuParams& p) { p.rt.coalescing = PolicyChoice<rt::Coalescer>("each_lane"); }},
    {"deferred any-hit", [](GpuParams& p) { p.rt.any_hit = PolicyChoice<rt::AnyHitMode>("deferred"); }},
    {"result stores", [](GpuParams& p) { p.rt.result_store = true; }},
    {"predicted starts", [](GpuParams& p) { p.rt.entry = PolicyChoice<rt::RayEntry>("predictor"); }},
    {"lanes that help each other",
     [](GpuParams& p) { p.rt.mapping = PolicyChoice<rt::WorkMapping>("cooperative"); }},
    {"prefetches from stacks",
     [](GpuParams& p) { p.rt.prefetch = PolicyChoice<rt::Prefetcher>("stack_trend"); }},
    {"threads sorted behind traces",
     [](GpuParams& p) {
       p.core.reorder = PolicyChoice<core::Reorder>("by_shader_record");
       p.core.reordering = {.batch = 2, .timeout = 700};
     }},
    {"warps that give up their places",
     [](GpuParams& p) {
       p.core.parking = PolicyChoice<core::Parking>("at_rays");
       p.core.warps = 4;
     }},
    {"paths of a warp that take turns",
     [](GpuParams& p) { p.core.interleaving = PolicyChoice<core::Interleaving>("on_stall"); }},
    {"loads held back for lines in the L1",
     [](GpuParams& p) {
       p.core.issue = PolicyChoice<core::IssueScheduler>("ccws");
       p.memory.l1.size = 1024;
     }},
    {"two RT entries", [](GpuParams& p) { p.rt.mshr_entries = 2; }},
    {"Vulkan-Sim's stores and headers",
     [](GpuParams& p) {
       p.rt.shortcuts.store_each_hit = p.rt.shortcuts.fetch_headers = p.rt.shortcuts.fetch_descriptors = true;
       p.rt.shortcuts.store_latency = 100;
     }},
    {"refresh of all banks", [](GpuParams& p) { p.memory.dram.refresh = "all_bank"; }},
    {"refresh bank by bank", [](GpuParams& p) { p.memory.dram.refresh = "per_bank"; }},
    {"the simple DRAM model",
     [](GpuParams& p) { p.memory.dram.model = PolicyChoice<mem::DramModel>("simple"); }},
    {"draining of writes",
     [](GpuParams& p) { p.memory.dram.scheduler = PolicyChoice<mem::DramScheduler>("write_drain"); }},
    {"one credit", [](GpuParams& p) { p.memory.noc.credits = 1; }},
    {"two sides of the chip", [](GpuParams& p) { p.memory.noc.sides = 2, p.memory.noc.far_latency = 30; }},
    {"two slices a partition", [](GpuParams& p) { p.memory.l2.slices = 2; }},
    {"small queues",
     [](GpuParams& p) {
       p.memory.l1.mshr_entries = p.memory.l1.miss_queue = 2;
       p.memory.l1.mshr_merges = p.memory.l2.mshr_entries = p.memory.l2.mshr_merges = 1;
       p.memory.l2.dram_queue = 8, p.memory.dram.queue = 1;
     }},
    {"allocation on misses, masks and fills that take time",
     [](GpuParams& p) {
       p.memory.l1.allocate = "on_miss";
       p.memory.l1.fill_takes_access = p.memory.l1.write_allocate = true;
       p.memory.l2.write_masks = p.memory.l2.fill_takes_service = true;
     }},
};

}  // namespace

TEST_CASE("with every preset, stepping, skipping and two threads give the same cycles and statistics") {
  const std::string preset =
      GENERATE("mobile", "desktop", "h200", "ideal-memory", "vulkan-sim-mobile", "vulkan-sim-desktop");
  CAPTURE(preset);
  GpuParams gpu = test::preset(preset);
  gpu.cores = std::min(gpu.cores, 4u);
  gpu.core.launch_latency = 100;
  check_equal(frames(gpu)[0]);
}

TEST_CASE("with every mechanism, stepping, skipping and two threads give the same cycles and statistics") {
  for (const Mechanism& mechanism : kMechanisms) {
    CAPTURE(mechanism.name);
    GpuParams gpu = test::preset("mobile");
    gpu.cores = 3;
    gpu.core.launch_latency = 100;
    mechanism.turn_on(gpu);
    for (const pipeline::RenderJob& job : frames(gpu)) check_equal(job);
  }
}

TEST_CASE("with every replacement policy, stepping, skipping and two threads give the same statistics") {
  for (const std::string& name : Registry<mem::Replacement>::names()) {
    CAPTURE(name);
    const PolicyChoice<mem::Replacement> choice(name.c_str());
    GpuParams gpu = test::preset("mobile");
    gpu.cores = 3;
    gpu.core.launch_latency = 100;
    gpu.memory.l1.replacement = gpu.memory.l2.replacement = gpu.core.fetch.replacement =
        gpu.core.constant.replacement = gpu.core.code_cache.replacement = choice;
    gpu.memory.l1.size = 4096, gpu.memory.l2.slice_size = 16384;
    gpu.core.fetch.size = gpu.core.constant.size = 512, gpu.core.code_cache.size = 2048;
    gpu.core.fetch.ways = gpu.core.constant.ways = gpu.core.code_cache.ways = 4;
    check_equal(frames(gpu)[0]);
  }
}

TEST_CASE("with every network, stepping, skipping and two threads give the same cycles and statistics") {
  for (const std::string& name : Registry<mem::Network>::names()) {
    CAPTURE(name);
    GpuParams gpu = test::preset("mobile");
    gpu.cores = 3;
    gpu.core.launch_latency = 100;
    gpu.memory.noc.topology = PolicyChoice<mem::Network>(name.c_str());
    for (const pipeline::RenderJob& job : frames(gpu)) check_equal(job);
  }
}
