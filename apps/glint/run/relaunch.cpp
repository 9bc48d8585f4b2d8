// Finds scene, program, pipeline or kernel of a run, and takes its launches through a machine.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/relaunch.h"

#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <system_error>

#include "apps/glint/bench/workloads.h"
#include "apps/glint/run/kernels.h"
#include "apps/glint/run/launch_file.h"
#include "apps/glint/run/pipeline.h"
#include "compute/host.h"
#include "pipeline/pipeline_world.h"
#include "pipeline/scene_world.h"
#include "pipeline/structure_cache.h"
#include "scenes/overrides.h"

namespace glint::app {
namespace {

double fact(const report::RunRecord& run, const std::string& directory, const std::string& name) {
  if (const std::optional<double> value = run.fact(name)) return *value;
  throw UserError({directory + "/run.json"}, fmt::format("has no '{}'", name),
                  "another version of Glint made the run: run it again");
}

// Returns the file that a run was made from.
std::string file_of(const report::RunRecord& run, const std::string& directory) {
  std::string file = run.text("scene.file");
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed))
    throw UserError({directory + "/run.json"},
                    fmt::format("the file of the run's scene, '{}', is not here", file),
                    "call `glint model` from the folder that the run was called from");
  return file;
}

// Returns the job of the launch that a run of a scene made.
pipeline::RenderJob job_of(const Session& session, const RelaunchOptions& options,
                           const report::RunRecord& run, const std::string& directory) {
  const WorkloadInfo& workload = find_workload(run.text("shader"));
  pipeline::RenderJob job;
  job.workload = workload.workload;
  for (const scenes::RenderParam& p : scenes::RenderParams::params())
    job.frame.*p.field = uint32_t(p.is_optional ? run.fact(std::string(p.key)).value_or(0)
                                                : fact(run, directory, std::string(p.key)));
  job.shader_dir = options.shader_dir.empty() ? session.resources.shader_dir(std::string(workload.folder))
                                              : options.shader_dir;
  const bool is_file = !run.text("scene.file").empty();
  const std::unique_ptr<scenes::SceneStore> store = open_scene_store(options.shaders, 0);
  job.scene = scenes::load_scene(is_file ? file_of(run, directory) : run.text("scene.name"),
                                 {.assets = options.assets, .threads = 0, .store = store.get()});
  scenes::override_scene(job.scene, run.texts_in("overrides"));
  if (fmt::format("{:016x}", job.scene.hash(0)) != run.text("scene.hash"))
    throw UserError(
        {directory + "/run.json"},
        fmt::format("the run's scene is '{}', and here it is '{}'", run.text("scene.form"), job.scene.form),
        is_file ? "the file has changed since, or the run had --instancing"
                : "--assets names the folder that the run was given");
  return job;
}

void relaunch_scene(const Session& session, const RelaunchOptions& options, const report::RunRecord& run,
                    const std::string& directory, const pipeline::GpuParams& gpu,
                    frontend::ShaderCache* cache, const LaunchTaker& take) {
  const std::unique_ptr<pipeline::StructureCache> structures =
      open_structure_cache(options.shaders, session.plugins);
  pipeline::RenderJob job = job_of(session, options, run, directory);
  job.gpu = gpu;
  job.glsl = glsl_options(options.shaders, cache);
  job.structure_cache = structures.get();
  const pipeline::SceneWorld scene(job);
  take(scene.world, false);
}

void relaunch_program(const Session& session, const report::RunRecord& run, const std::string& directory,
                      const pipeline::GpuParams& gpu, frontend::ShaderCache* cache, const LaunchTaker& take) {
  const compute::Program* program = compute::find_program(run.text("scene.name"));
  const std::string input = run.text("scene.note");
  if (!program || (input != program->small_input && input != program->full_input))
    throw UserError(
        {directory + "/run.json"},
        fmt::format("there is no program '{}' with the input '{}'", run.text("scene.name"), input),
        "another version of Glint made the run: run it again");
  compute::HostSetup setup{gpu, session.resources.shader_dir("compute"), {}, {}, cache};
  setup.run = [&take](const std::string&, const exec::World& world) { return take(world, true); };
  compute::run_program(*program, input == program->small_input ? compute::Size::Small : compute::Size::Full,
                       setup);
}

void relaunch_pipeline(const RelaunchOptions& options, const std::string& file,
                       const pipeline::GpuParams& gpu, frontend::ShaderCache* cache,
                       const LaunchTaker& take) {
  pipeline::PipelineWorld world(read_description(file, glsl_options(options.shaders, cache)), gpu);
  for (size_t i = 0; i < world.num_launches(); ++i)
    take(world.world(i), world.description().launches[i].warm);
}

void relaunch_kernels(const std::string& file, const pipeline::GpuParams& gpu, const LaunchTaker& take) {
  const LaunchFile launches = read_launch(file);
  Kernels kernels(launches, file, gpu, {});
  for (size_t i = 0; i < launches.launches.size(); ++i) take(kernels.prepare(i), launches.launches[i].warm);
}

}  // namespace

std::string why_not_relaunched(const report::RunRecord& run) {
  const std::string form = run.text("scene.form");
  if (run.fact("sequence.fps")) return "its scene moves from frame to frame";
  if (run.fact("rays.bounces") || form == "compute") return "";
  if (form != "pipeline" && form != "kernel")
    return "runs of " + (form.empty() ? "this kind" : form) + " cannot be made anew";
  if (run.text("scene.file").empty()) return "its run.json does not name the file that says what is launched";
  return "";
}

void relaunch(const Session& session, const RelaunchOptions& options, const report::RunRecord& run,
              const std::string& directory, const pipeline::GpuParams& gpu, const LaunchTaker& take) {
  const std::unique_ptr<frontend::ShaderCache> cache = open_shader_cache(options.shaders);
  const std::string form = run.text("scene.form");
  if (form == "compute")
    relaunch_program(session, run, directory, gpu, cache.get(), take);
  else if (form == "pipeline")
    relaunch_pipeline(options, file_of(run, directory), gpu, cache.get(), take);
  else if (form == "kernel")
    relaunch_kernels(file_of(run, directory), gpu, take);
  else
    relaunch_scene(session, options, run, directory, gpu, cache.get(), take);
}

}  // namespace glint::app
