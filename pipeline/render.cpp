// A frame from job to picture.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/render.h"

#include <chrono>

#include "pipeline/functional_machine.h"
#include "pipeline/run_stats.h"
#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"

namespace glint::pipeline {
namespace {

void run_on_functional_machine(const RenderJob& job, SceneWorld& scene, RenderResult& result) {
  const FunctionalCounts counts = run_functional(scene.world, job.gpu.core.instruction_budget, job.progress);
  std::copy(counts.by_class.begin(), counts.by_class.end(), result.by_class);
  result.rays = counts.rays;
  result.stats = std::make_unique<RunStats>(counts);
}

void run_on_timing_machine(const RenderJob& job, SceneWorld& scene, RenderResult& result) {
  auto machine = std::make_unique<TimingMachine>(job.gpu, scene.world, job.no_skip);
  result.cycles = machine->run(job.progress);
  machine->collect(result);
  result.stats = std::make_unique<RunStats>(std::move(machine));
}

}  // namespace

RenderResult::RenderResult() = default;
RenderResult::~RenderResult() = default;
RenderResult::RenderResult(RenderResult&&) noexcept = default;
RenderResult& RenderResult::operator=(RenderResult&&) noexcept = default;
const stats::Group& RenderResult::statistics() const { return stats->root(); }

RenderResult render(const RenderJob& job) {
  SceneWorld scene(job);
  RenderResult result;
  const auto begin = std::chrono::steady_clock::now();
  if (job.timing)
    run_on_timing_machine(job, scene, result);
  else
    run_on_functional_machine(job, scene, result);
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const ClassCounts& counts : result.by_class) {
    result.warp_instructions += counts.instructions;
    result.lane_instructions += counts.lanes;
  }
  result.width = job.frame.width;
  result.height = job.frame.height;
  result.structures = scene.structures;
  result.warnings = scene.warnings;
  result.rgba = scene.read_image(SceneWorld::kPicture);
  result.accumulation = scene.read_image(SceneWorld::kAccumulation);
  return result;
}

}  // namespace glint::pipeline
