// Makes a picture from the job of a frame.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/render.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "pipeline/functional_machine.h"
#include "pipeline/run_costs.h"
#include "pipeline/run_stats.h"
#include "pipeline/run_trace.h"
#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"

namespace glint::pipeline {
RenderResult::RenderResult() = default;
RenderResult::~RenderResult() = default;
RenderResult::RenderResult(RenderResult&&) noexcept = default;
RenderResult& RenderResult::operator=(RenderResult&&) noexcept = default;
const stats::Group& RenderResult::statistics() const {
  return stats->root();
}

namespace {

void keep_not_finite(RenderResult& result, exec::NotFiniteStores stores, const exec::Image& image) {
  result.not_finite = std::move(stores);
  for (const auto& [texel, store] : result.not_finite.by_texel())
    result.store_lines.try_emplace(store.pc, image.line_of(store.pc));
}

}  // namespace

RenderResult run_world(const exec::World& world, const GpuParams& gpu, bool timing, bool no_skip,
                       uint32_t threads, const LaunchWatch& watch, const Observation& observation) {
  RenderResult result;
  const auto costs = observation.heat ? std::make_unique<core::LaunchCosts>(world) : nullptr;
  const auto begin = std::chrono::steady_clock::now();
  if (timing) {
    auto machine = std::make_unique<TimingMachine>(gpu, world, no_skip, HostOptions{.threads = threads});
    observe(*machine, observation);
    const auto cost_recorders =
        costs ? record_costs(*machine, *costs) : std::vector<std::unique_ptr<core::CostRecorder>>{};
    const auto trace_recorders =
        observation.trace.wanted ? record_trace(*machine, *world.image, observation.trace) : TraceRecorders{};
    result.cycles = machine->run(watch);
    result.end = machine->end();
    result.progress = machine->progress();
    machine->collect(result);
    result.faults = machine->passed();
    keep_not_finite(result, machine->not_finite_stores(), *world.image);
    if (observation.profile) result.profile = profile_of(*machine, *world.image);
    if (observation.sample) result.series = series_of(*machine, observation.sample);
    if (observation.trace.wanted)
      result.trace =
          trace_of(*machine, *world.image, observation.trace, trace_recorders, observation.interval());
    result.stats = std::make_unique<RunStats>(std::move(machine));
  } else {
    const FunctionalCounts counts =
        run_functional(world, gpu.core.instruction_budget, watch, {}, costs.get(), threads);
    result.end = counts.end;
    result.progress = counts.progress;
    std::copy(counts.by_class.begin(), counts.by_class.end(), result.by_class);
    result.rays = counts.rays;
    result.faults = counts.faults;
    keep_not_finite(result, counts.not_finite, *world.image);
    result.stats = std::make_unique<RunStats>(counts);
  }
  if (costs) result.costs = cost_maps(*costs, timing);
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const ClassCounts& counts : result.by_class) {
    result.warp_instructions += counts.instructions;
    result.lane_instructions += counts.lanes;
  }
  return result;
}

namespace {

RenderResult render_world(SceneWorld& scene, const RenderJob& job) {
  scene.world.on_fault = job.on_fault;
  RenderResult result =
      run_world(scene.world, job.gpu, job.timing, job.no_skip, job.threads, job.watch, job.observe);
  result.width = job.frame.width;
  result.height = job.frame.height;
  result.structures = scene.structures;
  result.warnings = scene.warnings;
  result.rgba = scene.read_image(SceneWorld::kPicture);
  result.picture = scene.world.images[SceneWorld::kPicture];
  result.picture.base = result.picture.address_of({scene.world.first_id[0], scene.world.first_id[1]});
  result.accumulation = scene.read_image(SceneWorld::kAccumulation);
  return result;
}

}  // namespace

RenderResult render(const RenderJob& job) {
  SceneWorld scene(job);
  return render_world(scene, job);
}

RenderResult render_and_drain(RenderJob& job) {
  SceneWorld scene(job, SceneWorld::Drain{job.scene});
  return render_world(scene, job);
}

}  // namespace glint::pipeline
