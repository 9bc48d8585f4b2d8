// `glint run SCENE`: renders one frame on the simulated GPU, leaves a run directory, prints the summary.
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <fmt/format.h>
#include <memory>

#include "apps/glint/bench/progress_pipe.h"
#include "apps/glint/bench/workloads.h"
#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/frame_options.h"
#include "apps/glint/options/image_size.h"
#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/amber.h"
#include "apps/glint/run/pipeline.h"
#include "apps/glint/run/ptx.h"
#include "apps/glint/run/recorded_run.h"
#include "apps/glint/session.h"
#include "pipeline/render.h"
#include "pipeline/structure_cache.h"
#include "report/files/config_file.h"
#include "report/files/run_directory.h"
#include "report/terminal/progress.h"

namespace glint::app {
namespace {

struct Options {
  std::string scene, shader = "pt", config = "mobile", size = "128x128", mode = "timing", assets, out,
                     shader_dir, launch;
  std::vector<std::string> settings, more;
  scenes::RenderParams frame;
  uint64_t max_instructions = 0;
  bool json = false, no_skip = false, instancing = false;
  ShaderOptions shaders;
  uint64_t print_limit = 1000;
  uint32_t threads = 0;
  std::string on_fault_name = "stop";
  exec::OnFault on_fault = exec::OnFault::Stop;
  pipeline::Observation observe;
  bool config_given = false, mode_given = false;  // not left at their defaults
};

// SHIP_SH is SHIP with --shader sh.
void take_workload_name(Options& options, bool shader_given) {
  const std::optional<SceneAndShader> named = split_workload(options.scene);
  if (!named) return;
  if (shader_given && options.shader != named->shader)
    throw UserError({}, fmt::format("'{}' is {} with --shader {}, and --shader is {}", options.scene,
                                    named->scene, named->shader, options.shader));
  options.scene = named->scene;
  options.shader = named->shader;
}

pipeline::RenderJob make_job(const Session& session, const Options& options) {
  const WorkloadInfo& workload = find_workload(options.shader);
  pipeline::RenderJob job;
  job.gpu = read_config(session.resources, options.config, options.settings);
  if (options.max_instructions > 0) job.gpu.core.instruction_budget = options.max_instructions;
  job.workload = workload.workload;
  job.frame = options.frame;
  parse_size(options.size, job.frame);
  job.timing = options.mode == "timing";
  job.no_skip = options.no_skip;
  job.threads = options.threads;
  job.on_fault = options.on_fault;
  job.observe = options.observe;
  check_observation(job.observe, job.timing);
  job.shader_dir = options.shader_dir.empty() ? session.resources.shader_dir(std::string(workload.folder))
                                              : options.shader_dir;
  report::Progress progress(session.on_terminal ? stdout : nullptr, "loading", session.terminal);
  ProgressPipe pipe(session.progress_descriptor, "loading");
  job.scene = scenes::load_scene(options.scene, {options.assets, options.instancing, [&](double part) {
                                                   progress.update(uint64_t(100 * part), 100);
                                                   pipe.update(uint64_t(1000 * part), 1000);
                                                 }});
  return job;
}

std::string title_of(const pipeline::RenderJob& job, const Options& options) {
  return fmt::format("{} {}  {}x{}, {} spp, {} on {}", job.scene.name, options.shader, job.frame.width,
                     job.frame.height, job.frame.samples, options.mode, options.config);
}

report::RunInfo describe_run(const Session& session, const Options& options, const pipeline::RenderJob& job) {
  report::RunInfo info = new_run_info(session, job.gpu, options.config, options.mode);
  info.scene = job.scene.name;
  info.scene_form = job.scene.form;
  info.scene_note = job.scene.note;
  info.scene_hash = job.scene.hash();
  info.scene_triangles = job.scene.triangles();
  info.scene_fraction = job.scene.fraction();
  info.shader = options.shader;
  info.width = job.frame.width;
  info.height = job.frame.height;
  info.samples = job.frame.samples;
  info.seed = job.frame.seed;
  info.bounces = job.frame.bounces;
  info.shadow_rays = job.frame.shadow_rays;
  info.ao_rays = job.frame.ao_rays;
  return info;
}

Exit run_scripts(const Session& session, const Options& options) {
  AmberOptions amber{{options.scene},
                     options.config,
                     options.settings,
                     options.max_instructions,
                     options.mode_given && options.mode == "timing",
                     options.no_skip,
                     options.threads,
                     options.on_fault,
                     options.shaders,
                     options.print_limit};
  amber.scripts.insert(amber.scripts.end(), options.more.begin(), options.more.end());
  return run_amber(session, amber);
}

Exit run(const Session& session, const Options& options) {
  if (names_script(options.scene)) {
    if (observes(options.observe))
      throw UserError({}, "--profile, --sample, --heat and --trace do not go with Amber scripts",
                      "a script has no run directory");
    return run_scripts(session, options);
  }
  if (!options.more.empty())
    throw UserError({}, fmt::format("'{}' is one too many", options.more[0]),
                    "only Amber scripts run several at a time");
  if (names_pipeline(options.scene))
    return run_pipeline(session, {options.scene, options.config_given ? options.config : "",
                                  options.mode_given ? options.mode : "", options.out, options.settings,
                                  options.max_instructions, options.json, options.no_skip, options.threads,
                                  options.shaders, options.print_limit, options.on_fault, options.observe});
  if (names_kernel(options.scene))
    return run_ptx(session, {options.scene, options.launch, options.config, options.mode, options.out,
                             options.settings, options.max_instructions, options.json, options.no_skip,
                             options.threads, options.on_fault, options.observe});
  const std::unique_ptr<frontend::ShaderCache> cache = open_shader_cache(options.shaders);
  exec::PrintLog prints(options.print_limit);
  pipeline::RenderJob job = make_job(session, options);
  job.glsl = glsl_options(options.shaders, cache.get());
  const std::unique_ptr<pipeline::StructureCache> structures = open_structure_cache(options.shaders);
  job.structure_cache = structures.get();
  job.prints = &prints;
  const report::RunDirectory directory(
      options.out.empty() ? fmt::format("out/{}_{}-{}", job.scene.name, options.shader, options.mode)
                          : options.out);
  report::RunInfo info = describe_run(session, options, job);
  info.on_fault = exec::name_of(options.on_fault);
  begin_directory(directory, info, job.gpu, title_of(job, options));
  std::vector<std::string> files = {"picture    " + directory.path_of("image.png"),
                                    "statistics " + directory.path_of("stats.txt")};
  const pipeline::RenderResult result = run_recorded(
      session, "rendering", directory, info,
      [&](const ShowProgress& progress) {
        job.progress = progress;
        pipeline::RenderResult rendered = pipeline::render(job);
        const pipeline::StructureCounts& made = rendered.structures;
        info.structures = {made.bytes,     made.triangles, made.procedurals, made.bottom_levels,
                           made.instances, made.top_depth, made.bottom_depth};
        return rendered;
      },
      [&](const pipeline::RenderResult& rendered) {
        directory.write_image({rendered.width, rendered.height, rendered.rgba});
        directory.write_stats(rendered.statistics());
        for (std::string& line : write_observation(job.observe, rendered, directory))
          files.push_back(std::move(line));
      },
      &prints);
  for (const std::string& warning : result.warnings) fmt::print(stderr, "{}\n", warning);
  print_result(session, options.json, job, result, title_of(job, options), std::move(files));
  return Exit::Ok;
}

}  // namespace

void add_run(Command app, Session& session) {
  auto options = std::make_shared<Options>();
  Command command =
      app.add_subcommand("run", "Render a scene, or launch a pipeline or a PTX kernel, on the simulated GPU");
  command
      .add_option("SCENE", options->scene,
                  "Scene; 'glint list scenes' names them. Or a workload: SHIP_SH. Or a scene of your own: "
                  "FILE.obj, FILE.gltf, FILE.glb. Or a pipeline: FILE.toml, or one shader file. Or a "
                  "kernel: FILE.ptx, or its launch FILE.toml. Or an Amber script: FILE.amber")
      .required();
  command.add_option("MORE", options->more, "More Amber scripts, after a first one: FILE.amber");
  command.add_option("--launch", options->launch, "Launch file of a kernel: grid, block, arguments")
      .type_name("FILE");
  command.add_option("--shader", options->shader, "pt, sh or ao; 'glint list shaders' explains")
      .capture_default_str();
  command
      .add_option("--shader-dir", options->shader_dir,
                  "Folder with the workload's shaders instead of the built-in ones")
      .type_name("DIR");
  command.add_option("--config", options->config, "Preset or TOML file").capture_default_str();
  command.add_option("--set", options->settings, "Override of a key, repeatable: core.warps=16")
      .type_name("KEY=VALUE")
      .allow_extra_args(false);
  command.add_option("--mode", options->mode, "timing: cycle by cycle; functional: picture and counts only")
      .one_of({"timing", "functional"})
      .capture_default_str();
  command.add_option("--assets", options->assets, "Folder of original scene data")
      .type_name("DIR")
      .envname("GLINT_ASSETS");
  command.add_flag("--instancing", options->instancing,
                   "Models of a scene that are affine copies of another share its structure and vertices");
  command.add_option("--out", options->out, "Run directory (default: out/SCENE_SHADER-MODE)")
      .type_name("DIR");
  command
      .add_option("--max-instructions", options->max_instructions,
                  "Instructions after which a warp is held to have no end")
      .positive();
  command
      .add_option("--on-fault", options->on_fault_name,
                  "stop: the first fault ends the run; warn: wrong loads give 0, wrong stores do nothing, "
                  "and each is listed (docs/errors.md)")
      .one_of({"stop", "warn"})
      .capture_default_str();
  command.add_flag("--json", options->json, "Print the statistics as JSON instead of the summary");
  command.add_flag("--no-skip", options->no_skip, "Step every cycle: slow, same result, for checking");
  command
      .add_option("--threads", options->threads,
                  "Threads of the timing machine, same result with any number; 0: all processors, while "
                  "they are faster than one")
      .in_range(0u, 256u)
      .capture_default_str();
  command
      .add_option("--printf-limit", options->print_limit,
                  "Messages of debugPrintfEXT to show, the first by launch id")
      .capture_default_str();
  add_observe_options(command, options->observe);
  add_shader_options(command, options->shaders);
  command.add_option("--size", options->size, "Image size in pixels").type_name("WxH").capture_default_str();
  add_frame_options(command, options->frame);
  command.add_option("--progress-fd", session.progress_descriptor, "Descriptor to write the progress to")
      .group("");             // for `bench`
  command.last_value_wins();  // so that a script's own options can be overridden by those it is given
  command.callback([&session, options, command] {
    options->config_given = command.count("--config") > 0;
    options->mode_given = command.count("--mode") > 0;
    options->on_fault = options->on_fault_name == "warn" ? exec::OnFault::Warn : exec::OnFault::Stop;
    if (options->shaders.contract) options->settings.push_back("compiler.contract=true");
    const bool shader_given = command.count("--shader") > 0;
    session.action = [&session, options, shader_given] {
      take_workload_name(*options, shader_given);
      return run(session, *options);
    };
  });
}

}  // namespace glint::app
