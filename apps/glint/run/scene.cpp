// Renders one frame, leaves a run directory and prints the summary.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/scene.h"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <system_error>
#include <utility>

#include "apps/glint/bench/progress_pipe.h"
#include "apps/glint/bench/workloads.h"
#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/frames.h"
#include "apps/glint/run/recorded_run.h"
#include "apps/glint/run/single_launch.h"
#include "base/host_threads.h"
#include "pictures/exr.h"
#include "pipeline/render.h"
#include "pipeline/sampling/sampled_run.h"
#include "pipeline/structure_cache.h"
#include "report/files/run_directory.h"
#include "report/terminal/progress.h"
#include "scenes/import/scene_file.h"
#include "setup/recorded_launch.h"

namespace glint::app {
namespace {

// Splits the name of a workload: SHIP_SH is SHIP with --shader sh.
void take_workload_name(SceneOptions& options) {
  const std::optional<SceneAndShader> named = split_workload(options.scene);
  if (!named) return;
  if (options.shader_given && options.shader != named->shader)
    throw UserError({}, fmt::format("'{}' is {} with --shader {}, but --shader is {}", options.scene,
                                    named->scene, named->shader, options.shader));
  options.scene = named->scene;
  options.shader = named->shader;
  if (!options.sequence.is_wanted()) options.sequence.frames = named->frames;
}

// Names of scenes have no dots and slashes, so what has one is a file of a kind that Glint does not know.
void refuse_file(const std::string& what) {
  if (what.find_first_of("./") == std::string::npos || scenes::names_scene_file(what)) return;
  std::error_code failed;
  const bool is_folder = std::filesystem::is_directory(what, failed);
  const std::string ending = std::filesystem::path(what).extension().string();
  throw UserError(
      {what},
      is_folder        ? "this is a folder, and Glint runs files"
      : ending.empty() ? "this file has no ending that says what it is"
                       : fmt::format("Glint does not run files that end in {}", ending),
      "it runs scenes (.obj, .gltf, .glb), shaders (.rgen, .comp, .spv, .spvasm), pipelines (.toml), "
      "kernels (.ptx), capsules (.capsule), Amber scripts (.amber) and the scenes of 'glint list scenes'");
}

// Renders a sample of the job's frame, and notes in `info` what was sampled.
pipeline::SampledRun render_sample(const SampleChoice& choice, report::RunInfo& info,
                                   pipeline::RenderJob& job) {
  const pipeline::SampleOptions options = choice.options();
  pipeline::SampledRun run = pipeline::render_sampled(job, options);
  info.sample = sample_info(options, run.plan);
  return run;
}

// Renders the job and leaves its files in the directory.
pipeline::RenderResult render_into(const Session& session, const report::RunDirectory& directory,
                                   report::RunInfo& info, pipeline::RenderJob& job,
                                   const SceneOptions& options, const LaunchOptions& launch,
                                   std::vector<std::string>& files, pipeline::SampledRun& sampled) {
  const bool has_built_in_shaders = options.shader_dir.empty();
  const auto render = [&](const pipeline::LaunchWatch& watch) {
    job.watch = watch;
    job.watch.is_bounded = has_built_in_shaders;  // Their loops count to numbers of rays.
    if (launch.sample.wants_pixels()) sampled = render_sample(launch.sample, info, job);
    pipeline::RenderResult rendered =
        launch.sample.wants_pixels() ? std::move(sampled.result) : pipeline::render_and_drain(job);
    info.structures = structure_info(rendered.structures);
    return rendered;
  };
  const auto keep = [&](const pipeline::RenderResult& rendered) {
    const pictures::ImageView image{rendered.width, rendered.height, rendered.rgba};
    directory.write_image(image, host_threads(job.threads));
    if (options.exr) directory.write("image.exr", pictures::exr_bytes(image));
    note_not_finite("image.pfm", image, rendered.picture, rendered, info);
    directory.write_stats(rendered.statistics(), info.compact);
    if (launch.sample.wants_pixels()) directory.write("sample.csv", pipeline::batches_csv(sampled));
    for (std::string& line : write_observation(job.observe, rendered, directory))
      files.push_back(std::move(line));
  };
  return run_recorded(session, launch.max_cycles, directory, info, render, keep, job.prints);
}

}  // namespace

std::string SceneOptions::given() const {
  const std::string own = exr ? "--exr" : frame.given();
  return !own.empty() ? own : sequence.is_wanted() ? "--frames" : sequence.given();
}

void check_scene(SceneOptions& options) {
  refuse_file(options.scene);
  take_workload_name(options);
}

pipeline::RenderJob frame_job(const Session& session, const SceneOptions& options, uint32_t threads,
                              scenes::SceneStore* store) {
  const WorkloadInfo& workload = find_workload(options.shader);
  pipeline::RenderJob job;
  job.workload = workload.workload;
  job.frame = options.frame.frame();
  job.threads = threads;
  job.shader_dir = options.shader_dir.empty() ? session.resources.shader_dir(std::string(workload.folder))
                                              : options.shader_dir;
  report::Progress progress(session.on_terminal ? stdout : nullptr, "loading", session.terminal);
  ProgressPipe pipe(session.progress_descriptor, "loading");
  job.scene = scenes::load_scene(options.scene,
                                 {options.assets, options.instancing,
                                  [&](double part) {
                                    progress.update(uint64_t(100 * part), 100);
                                    pipe.update(uint64_t(1000 * part), 1000);
                                  },
                                  threads, options.sequence.is_wanted(), options.sequence.animation, store});
  scenes::override_scene(job.scene, options.frame.overrides());
  return job;
}

namespace {

pipeline::RenderJob scene_job(const Session& session, const SceneOptions& options,
                              const LaunchOptions& launch) {
  pipeline::GpuParams gpu = gpu_of(session.resources, launch);
  const std::unique_ptr<scenes::SceneStore> store = open_scene_store(launch.shaders, launch.threads);
  pipeline::RenderJob job = frame_job(session, options, launch.threads, store.get());
  job.gpu = std::move(gpu);
  job.timing = launch.mode == "timing";
  job.no_skip = launch.no_skip;
  job.on_fault = launch.on_fault;
  job.observe = launch.observe;
  return job;
}

}  // namespace

ReadySceneJob::ReadySceneJob(const Session& session, const SceneOptions& options, const LaunchOptions& launch)
    : shaders(open_shader_cache(launch.shaders)),
      structures(open_structure_cache(launch.shaders, session.plugins)),
      prints(launch.print_limit),
      job(scene_job(session, options, launch)) {
  job.glsl = glsl_options(launch.shaders, shaders.get());
  job.structure_cache = structures.get();
  job.prints = &prints;
}

report::StructureInfo structure_info(const pipeline::StructureCounts& made) {
  return {made.bytes,     made.triangles, made.procedurals, made.bottom_levels,
          made.instances, made.top_depth, made.bottom_depth};
}

std::string title_of(const pipeline::RenderJob& job, const SceneOptions& options,
                     const LaunchOptions& launch) {
  const scenes::RenderParams& frame = job.frame;
  const std::string window = frame.frame_width ? fmt::format(" at {},{} of {}x{}", frame.crop_x, frame.crop_y,
                                                             frame.frame_width, frame.frame_height)
                                               : "";
  return fmt::format("{} {}  {}x{}{}, {} spp, {} on {}", job.scene.name, options.shader, frame.width,
                     frame.height, window, frame.samples, launch.mode, launch.config);
}

report::RunInfo describe_scene(const Session& session, const SceneOptions& options,
                               const LaunchOptions& launch, const pipeline::RenderJob& job) {
  report::RunInfo info = new_run_info(session, job.gpu, launch.config, launch.mode);
  info.scene = job.scene.name;
  info.scene_form = job.scene.form;
  if (scenes::names_scene_file(options.scene)) info.scene_file = options.scene;
  info.scene_note = job.scene.note;
  info.scene_hash = job.scene.hash(job.threads);
  info.scene_triangles = job.scene.triangles();
  info.scene_fraction = job.scene.fraction();
  info.shader = options.shader;
  info.frame = scenes::values_of(job.frame);
  info.overrides = options.frame.overrides();
  info.on_fault = exec::name_of(launch.on_fault);
  info.compact = launch.compact();
  return info;
}

void check_scene_run(SceneOptions options, const LaunchOptions& launch) {
  check_scene(options);
  const bool timing = launch.mode == "timing", is_sequence = options.sequence.is_wanted();
  check_observation(launch.observe, timing);
  check_max_cycles(launch.max_cycles, timing);
  if (is_sequence && launch.sample.wants_pixels())
    throw UserError({}, "--sample-pixels cannot be used with --frames",
                    "sample one frame, or time some of the frames with --sample-launches");
  if (!is_sequence && launch.sample.wants_launches())
    throw UserError({}, "--sample-launches needs --frames, because a frame is one launch",
                    "--sample-pixels times a share of one frame");
  if (!options.sequence.animation.empty() && !scenes::names_scene_file(options.scene))
    throw UserError({}, fmt::format("--animation belongs to glTF files, and '{}' is none", options.scene));
  if (is_sequence)
    sequence_of(options.sequence);
  else
    check_without_frames(options.sequence);
}

Exit run_scene(const Session& session, SceneOptions options, const LaunchOptions& launch) {
  check_scene(options);
  if (options.sequence.is_wanted()) return run_frames(session, options, launch);
  ReadySceneJob ready(session, options, launch);
  pipeline::RenderJob& job = ready.job;
  report::RunDirectory directory(
      launch.out.empty() ? fmt::format("out/{}_{}-{}", job.scene.name, options.shader, launch.mode)
                         : launch.out);
  report::RunInfo info = describe_scene(session, options, launch, job);
  const std::string title = title_of(job, options, launch);
  setup::begin_directory(directory, info, job.gpu, title);
  std::vector<std::string> files = {
      "picture    " + directory.path_of("image.png"),
      "statistics " + directory.path_of(launch.compact() ? "stats.csv" : "stats.txt")};
  pipeline::SampledRun sampled;
  const pipeline::RenderResult result =
      render_into(session, directory, info, job, options, launch, files, sampled);
  for (const std::string& warning : result.warnings) fmt::print(stderr, "{}\n", warning);
  return print_result(session, launch.json, job, result, info, title, std::move(files), sampled.estimates);
}

}  // namespace glint::app
