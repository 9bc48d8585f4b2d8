// Makes a picture from the job of a frame.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/render.h"

#include "pipeline/device.h"
#include "pipeline/run_stats.h"
#include "pipeline/scene_launch.h"

namespace glint::pipeline {
RenderResult::RenderResult() = default;
RenderResult::~RenderResult() = default;
RenderResult::RenderResult(RenderResult&&) noexcept = default;
RenderResult& RenderResult::operator=(RenderResult&&) noexcept = default;
const stats::Group& RenderResult::statistics() const {
  return stats->root();
}

void RenderResult::add(const RenderResult& next) {
  end = next.end, progress = next.progress;
  cycles += next.cycles;
  warp_instructions += next.warp_instructions, lane_instructions += next.lane_instructions;
  for (size_t c = 0; c < size_t(isa::Class::Count); ++c) {
    by_class[c].instructions += next.by_class[c].instructions;
    by_class[c].lanes += next.by_class[c].lanes;
    by_class[c].latency += next.by_class[c].latency;
  }
  rays.rays += next.rays.rays, rays.nodes += next.rays.nodes;
  rays.box_tests += next.rays.box_tests, rays.triangle_tests += next.rays.triangle_tests;
  faults.add(next.faults);
  wall_seconds += next.wall_seconds;
  if (stats && next.stats) stats->root().take_in(next.statistics());
}

RenderResult run_world(const exec::World& world, const GpuParams& gpu, bool timing, bool no_skip,
                       uint32_t threads, const LaunchWatch& watch, const Observation& observe) {
  Device device(gpu);
  return device.run(world, {timing, no_skip, threads, Caches::Cold, observe}, watch);
}

RenderResult launch_scene(Device& device, SceneWorld& scene, const RenderJob& job, Caches caches) {
  scene.world.on_fault = job.on_fault;
  RenderResult result =
      device.run(scene.world, {job.timing, job.no_skip, job.threads, caches, job.observe}, job.watch);
  read_frame(scene, job, result);
  return result;
}

void read_frame(const SceneWorld& scene, const RenderJob& job, RenderResult& result) {
  result.width = job.frame.width;
  result.height = job.frame.height;
  result.structures = scene.structures;
  result.warnings = scene.warnings;
  result.rgba = scene.read_image(SceneWorld::kPicture);
  result.picture = scene.world.images[SceneWorld::kPicture];
  result.picture.base = result.picture.address_of({scene.world.first_id[0], scene.world.first_id[1]});
  result.accumulation = scene.read_image(SceneWorld::kAccumulation);
}

RenderResult render(const RenderJob& job) {
  SceneWorld scene(job);
  Device device(job.gpu);
  return launch_scene(device, scene, job, Caches::Cold);
}

RenderResult render_and_drain(RenderJob& job) {
  SceneWorld scene(job, SceneWorld::Drain{job.scene});
  Device device(job.gpu);
  return launch_scene(device, scene, job, Caches::Cold);
}

}  // namespace glint::pipeline
