// Tests that the interval model counts what is executed, takes the configuration's times, and predicts well.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "pipeline/functional_machine.h"
#include "pipeline/interval/interval_machine.h"
#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

using namespace glint;
using namespace glint::pipeline;

namespace {

// Returns a job on two cores of the preset `mobile`.
RenderJob mobile_job(const std::string& scene, Workload workload, uint32_t size) {
  RenderJob job = test::small_job(scene, workload, size, 1);
  job.gpu = test::preset("mobile");
  job.gpu.cores = 2;
  return job;
}

}  // namespace

TEST_CASE("A resource serves as much as it can, and late requests do not hold up early ones", "[interval]") {
  Bandwidth one;
  CHECK(one.take(100, 2) == 100);
  CHECK(one.take(900, 2) == 900);
  CHECK(one.take(100, 2) >= 100);
  CHECK(one.take(100, 2) < 110);
  Cycle last = 0;
  Bandwidth busy;
  for (int i = 0; i < 1000; ++i) last = std::max(last, busy.take(0, 2));
  CHECK(last + 2 >= 2000);  // all of the work, and not much more
  CHECK(last < 2100);
  CHECK(busy.total() == 2000);
}

TEST_CASE("An access takes the latencies of the levels that it comes to", "[interval]") {
  const GpuParams gpu = test::preset("mobile");
  MemoryModel memory(gpu.memory, 2, gpu.clock_mhz);
  const mem::Params& m = gpu.memory;
  const Cycle below = m.l1.miss_latency + m.noc.request_latency + m.l2.latency + m.noc.reply_latency;
  const Cycle cold = memory.read(0, 0, 1, 1000, Asker::Shader) - 1000;
  CHECK(cold > below + m.dram.latency);
  CHECK(memory.read(0, 0, 1, 5000, Asker::Shader) - 5000 == m.l1.hit_latency);
  const Cycle l2_hit = memory.read(1, 0, 1, 9000, Asker::RtUnit) - 9000;
  CHECK(l2_hit >= below);
  CHECK(l2_hit <= below + 6);  // packets pass two ports
  CHECK(memory.l1()[0].reads == 2);
  CHECK(memory.l1()[0].misses == 1);
  CHECK(memory.l1()[1].misses == 1);
  CHECK(memory.l2().misses == 1);
  CHECK(memory.dram_sectors() == 1);
}

TEST_CASE("What is read before it has come waits for it", "[interval]") {
  const GpuParams gpu = test::preset("mobile");
  MemoryModel memory(gpu.memory, 1, gpu.clock_mhz);
  const Cycle ready = memory.read(0, 0, 1, 1000, Asker::Shader);
  CHECK(memory.read(0, 0, 1, 1010, Asker::Shader) == ready);
}

TEST_CASE("Local memory that a core writes and reads again stays in its L1 until it is displaced",
          "[interval]") {
  const GpuParams gpu = test::preset("mobile");
  MemoryModel memory(gpu.memory, 1, gpu.clock_mhz);
  memory.write(0, 0, 15, 1000, true);
  CHECK(memory.read(0, 0, 15, 2000, Asker::Shader) - 2000 == gpu.memory.l1.hit_latency);
  const uint32_t lines = uint32_t(gpu.memory.l1.size / gpu.memory.line);
  for (uint32_t i = 1; i <= lines; ++i) memory.read(0, i * gpu.memory.line, 1, 3000 + i, Asker::Shader);
  CHECK(memory.read(0, 0, 15, 900000, Asker::Shader) - 900000 > gpu.memory.l1.hit_latency);
  // The line that came back was there, because it was written when it was displaced.
  CHECK(memory.l2().misses == lines);
}

TEST_CASE("The pass executes what the functional machine does and leaves its picture", "[interval]") {
  const auto workload = GENERATE(Workload::PathTracing, Workload::AmbientOcclusion);
  const RenderJob job = mobile_job("WKND", workload, 16);
  SceneWorld first(job), second(job);
  const FunctionalCounts counts = run_functional(first.world, job.gpu.core.instruction_budget, {});
  IntervalMachine machine(job.gpu, second.world);
  const IntervalEstimate estimate = machine.run({});
  uint64_t instructions = 0, lanes = 0;
  for (const ClassCounts& one : counts.by_class) instructions += one.instructions, lanes += one.lanes;
  CHECK(estimate.instructions == instructions);
  CHECK(estimate.lanes == lanes);
  CHECK(estimate.rays.rays == counts.rays.rays);
  CHECK(estimate.rays.nodes == counts.rays.nodes);
  CHECK(first.read_image(SceneWorld::kPicture) == second.read_image(SceneWorld::kPicture));
}

TEST_CASE("The prediction is within a fifth of the timing machine, above every bound, and the same each time",
          "[interval]") {
  const std::string scene = GENERATE("WKND", "SHIP");
  const auto workload = GENERATE(Workload::PathTracing, Workload::Shadow);
  const RenderJob job = mobile_job(scene, workload, 64);
  SceneWorld first(job), second(job), third(job);
  TimingMachine timing(job.gpu, first.world, false);
  const auto simulated = double(timing.run({}));
  IntervalMachine machine(job.gpu, second.world), again(job.gpu, third.world);
  const IntervalEstimate estimate = machine.run({});
  INFO(scene << ": simulated " << simulated << ", predicted " << estimate.cycles);
  CHECK(std::abs(double(estimate.cycles) / simulated - 1) < 0.2);
  for (const auto& [name, cycles] : estimate.bounds()) CHECK(double(estimate.cycles) >= cycles);
  CHECK(again.run({}).cycles == estimate.cycles);
}

TEST_CASE("A slower test pipe and a smaller cache make the prediction longer", "[interval]") {
  RenderJob job = mobile_job("SHIP", Workload::Shadow, 32);
  const auto predicted = [&] {
    SceneWorld scene(job);
    return IntervalMachine(job.gpu, scene.world).run({}).cycles;
  };
  const Cycle base = predicted();
  job.gpu.rt.box.latency = 100;
  const Cycle slow_tests = predicted();
  CHECK(slow_tests > base + base / 10);
  job.gpu.memory.l1.size = 2048;
  CHECK(predicted() > slow_tests);
}

TEST_CASE("Launches that the model does not know are refused", "[interval]") {
  RenderJob job = mobile_job("WKND", Workload::Shadow, 8);
  SceneWorld scene(job);
  job.gpu.rt.scheduler = "round_robin";
  job.gpu.rt.result_store = true;
  CHECK_THROWS_WITH(IntervalMachine(job.gpu, scene.world),
                    Catch::Contains("rt.scheduler") && Catch::Contains("rt.result_store"));
}
