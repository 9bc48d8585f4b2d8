// Measures how fast the machines run whole frames and arithmetic, in warp instructions per second, node
// visits per second and simulated cycles.
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "pipeline/description/defaults.h"
#include "pipeline/pipeline_world.h"
#include "tests/support/small_jobs.h"

using namespace glint;

namespace {

// Runs a frame. Its time is that of the run alone, without compiling shaders and building structures.
void run_frame(benchmark::State& state, const char* scene, pipeline::Workload workload, bool timing) {
  pipeline::RenderJob job = test::small_job(scene, workload, 128, 2);
  job.gpu = test::preset("mobile");
  job.timing = timing;
  double instructions = 0, seconds = 0, nodes = 0, cycles = 0;
  for (auto _ : state) {
    const pipeline::RenderResult result = pipeline::render(job);
    state.SetIterationTime(result.wall_seconds);
    instructions += double(result.warp_instructions);
    nodes += double(result.rays.nodes);
    cycles += double(result.cycles);
    seconds += result.wall_seconds;
  }
  state.counters["warp_instructions/s"] = instructions / seconds;
  state.counters["nodes/s"] = nodes / seconds;
  state.counters["warp_instructions"] = instructions / double(state.iterations());
  if (timing) state.counters["cycles"] = cycles / double(state.iterations());
}

// Runs 65,536 threads that only calculate, on one thread of the host.
void run_arithmetic(benchmark::State& state, bool timing) {
  const std::string shader = std::string(GLINT_SOURCE_DIR) + "/bench/arithmetic.comp";
  const pipeline::PipelineDescription description =
      pipeline::parse_pipeline(pipeline::default_description({shader}, "/"), "/arithmetic.toml");
  const pipeline::GpuParams gpu = test::preset("mobile");
  double instructions = 0, seconds = 0;
  for (auto _ : state) {
    pipeline::PipelineWorld world(description, gpu);
    const pipeline::RenderResult result = pipeline::run_world(world.world(), gpu, timing, false, 1, {});
    state.SetIterationTime(result.wall_seconds);
    instructions += double(result.warp_instructions);
    seconds += result.wall_seconds;
  }
  state.counters["warp_instructions/s"] = instructions / seconds;
}
BENCHMARK_CAPTURE(run_arithmetic, functional, false)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_arithmetic, timing, true)->UseManualTime()->Unit(benchmark::kMillisecond);

#define GLINT_FRAME(scene, workload)                                                                         \
  BENCHMARK_CAPTURE(run_frame, scene##_##workload##_functional, #scene, pipeline::Workload::workload, false) \
      ->UseManualTime()                                                                                      \
      ->Unit(benchmark::kMillisecond);                                                                       \
  BENCHMARK_CAPTURE(run_frame, scene##_##workload##_timing, #scene, pipeline::Workload::workload, true)      \
      ->UseManualTime()                                                                                      \
      ->Unit(benchmark::kMillisecond)
GLINT_FRAME(WKND, PathTracing);
GLINT_FRAME(SHIP, Shadow);
GLINT_FRAME(BUNNY, AmbientOcclusion);

}  // namespace

BENCHMARK_MAIN();
