// Declares `glint run`, which finds out what to launch (a scene, a pipeline, a kernel, scripts) and launches
// it.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <memory>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/frame_options.h"
#include "apps/glint/run/amber.h"
#include "apps/glint/run/capsule.h"
#include "apps/glint/run/compute.h"
#include "apps/glint/run/pipeline.h"
#include "apps/glint/run/ptx.h"
#include "apps/glint/run/scene.h"
#include "apps/glint/session.h"

namespace glint::app {
namespace {

constexpr const char* kLaunchOption = "--launch";

struct RunOptions {
  SceneOptions scene;
  LaunchOptions launch;
  std::string kernel_launch;             // launch file of a kernel
  std::vector<std::string> more;         // Amber scripts after the first
  ScriptOptions script;                  // for Amber scripts
  std::string caches;                    // "cold", "warm", or empty: the default of what runs
  bool small = false;                    // for compute programs
  std::vector<std::string> of_one_kind;  // options that were given and that one kind of input reads
};

bool is_scene(const std::string& what) {
  return !names_script(what) && !names_pipeline(what) && !names_kernel(what) && !names_program(what) &&
         !names_capsule(what);
}

// Refuses options that only scenes understand.
void check_scene_options(const RunOptions& options) {
  const std::string &what = options.scene.scene, option = options.scene.given();
  if (option.empty() || is_scene(what)) return;
  throw UserError({}, fmt::format("{} belongs to scenes, and '{}' is none", option, what),
                  option == "--exr" ? "a pipeline keeps a picture with save = \"NAME.exr\" under [[image]]"
                  : names_capsule(what) ? "a capsule has all that its launch needs"
                  : names_program(what) ? "its input is the full one, or the small one with --small"
                                        : "what a pipeline, a kernel or a script renders stands in its file");
}

// Refuses options that nothing of what runs would read.
void check_unread_options(const RunOptions& options) {
  const std::string& what = options.scene.scene;
  const ShaderOptions& shaders = options.launch.shaders;
  const bool compiles = is_scene(what) || names_pipeline(what) || names_program(what);
  if (!compiles && !(shaders.include_dirs.empty() && shaders.defines.empty()))
    throw UserError({}, fmt::format("-I and -D cannot be used with '{}'", what),
                    "they are for the shaders of scenes and pipelines, and for files of shaders");
  if (names_script(what) && options.launch.json)
    throw UserError({}, "--json cannot be used with Amber scripts",
                    "with --out, each launch has a folder with its statistics");
}

// Returns those options that were given and that one kind of input reads alone.
std::vector<std::string> given_of_one_kind(const Command& command) {
  std::vector<std::string> out = {kLaunchOption, "--size", "--shader", "--shader-dir", "--instancing"};
  for (const scenes::RenderParam& p : scenes::RenderParams::params())
    if (!p.option.empty()) out.emplace_back(p.option);
  std::erase_if(out, [&](const std::string& option) { return !command.count(option); });
  return out;
}

// Says which options change nothing. They are no errors, because all workloads of a sweep get the same ones.
void warn_of_unread_options(const RunOptions& options) {
  const std::string& what = options.scene.scene;
  for (const std::string& option : options.of_one_kind)
    if (option == kLaunchOption && !what.ends_with(".ptx"))
      fmt::print(stderr, "warning: {} changes nothing, because only a kernel (.ptx) has a launch file\n",
                 option);
    else if (option != kLaunchOption && !is_scene(what))
      fmt::print(stderr, "warning: {} changes nothing, because only scenes read it\n", option);
}

// Refuses to sample the blocks of what has more launches than one, and the launches of what does not launch
// several.
void check_sampled(const RunOptions& options) {
  check_sample(options.launch);
  const SampleChoice& sample = options.launch.sample;
  const std::string& what = options.scene.scene;
  if (sample.wants_pixels() && (names_script(what) || names_program(what)))
    throw UserError({}, fmt::format("--sample-pixels cannot be used with '{}'", what),
                    "it samples the blocks of one launch, of a scene, a pipeline, a kernel or a capsule; "
                    "--sample-launches samples several launches");
  if (sample.wants_launches() && (names_script(what) || names_capsule(what)))
    throw UserError({}, fmt::format("--sample-launches cannot be used with '{}'", what),
                    "it samples compute programs, lists of launches and --frames");
}

// Refuses options that do not go together, or not with what is run. It looks at no more than names.
void check(const RunOptions& options) {
  const std::string& what = options.scene.scene;
  check_scene_options(options);
  check_unread_options(options);
  check_sampled(options);
  if (options.small && !names_program(what))
    throw UserError({}, fmt::format("--small belongs to compute programs, and '{}' is none", what),
                    "'glint list programs' names them");
  if (names_program(what)) check_program(what, options.launch);
  if (is_scene(what)) check_scene_run(options.scene, options.launch);
}

Exit run(const Session& session, const RunOptions& options) {
  const std::string& what = options.scene.scene;
  check(options);
  warn_of_unread_options(options);
  if (names_script(what)) {
    if (options.launch.max_cycles)
      throw UserError({}, "--max-cycles cannot be used with Amber scripts",
                      "what a script expects needs whole launches; --max-instructions bounds a warp");
    std::vector<std::string> scripts = {what};
    scripts.insert(scripts.end(), options.more.begin(), options.more.end());
    return run_amber(session, scripts, options.launch, options.script);
  }
  if (options.script.strict)
    throw UserError({}, "--strict belongs to Amber scripts",
                    "in other launches every access outside of a buffer or an image is a fault");
  if (!options.caches.empty() && !is_scene(what))
    throw UserError({}, kCachesElsewhere,
                    "files with a list of launches say it for each launch: caches = \"warm\"");
  if (!options.more.empty())
    throw UserError({}, fmt::format("'{}' is one argument too many", options.more[0]),
                    "only Amber scripts can be run several at a time");
  if (names_program(what)) return run_program(session, what, options.small, options.launch);
  if (names_capsule(what)) return run_capsule(session, what, options.launch);
  if (names_pipeline(what)) return run_pipeline(session, what, options.launch);
  if (names_kernel(what)) return run_ptx(session, what, options.kernel_launch, options.launch);
  return run_scene(session, options.scene, options.launch);
}

void add_scene_options(Command command, RunOptions& options) {
  command
      .add_option("SCENE", options.scene.scene,
                  "What to run: a scene ('glint list scenes' names them), a workload (SHIP_SH), a scene of "
                  "your own (FILE.obj, FILE.gltf, FILE.glb), a compute program ('glint list programs' names "
                  "them), a pipeline (FILE.toml, or one shader file), a "
                  "kernel (FILE.ptx, or its launch FILE.toml), a launch that the Vulkan driver has saved "
                  "(FILE.capsule) or an Amber script (FILE.amber)")
      .required();
  command.add_option("MORE", options.more, "More Amber scripts to run after the first one");
  command
      .add_option(kLaunchOption, options.kernel_launch,
                  "Launch file of a kernel, which gives grid, block and arguments")
      .type_name("FILE");
  command
      .add_option("--shader", options.scene.shader,
                  "Shader set to use: pt, sh or ao; 'glint list shaders' explains them")
      .capture_default_str();
  command
      .add_option("--shader-dir", options.scene.shader_dir,
                  "Folder whose shaders are used instead of the workload's built-in ones")
      .type_name("DIR");
  add_frame_options(command, options.scene.frame);
  add_sequence_options(command, options.scene.sequence);
  add_assets_option(command, options.scene.assets);
  command.add_flag(
      "--strict", options.script.strict,
      "Let accesses outside of buffers and images be faults in Amber scripts that do not declare "
      "robust access");
  command
      .add_option(
          "--caches", options.caches,
          "Selects what each launch of an Amber script, and each frame, finds in the L2 and in DRAM's "
          "row buffers: cold means nothing, and warm what the launch before it has left (default: cold "
          "for scripts, warm for frames)")
      .one_of({"cold", "warm"});
  command.add_flag("--small", options.small, "Run a compute program on its small input");
  command.add_flag("--exr", options.scene.exr,
                   "Also write the picture of a scene as image.exr: floats of 32 bits, with transparency");
  command.add_flag("--instancing", options.scene.instancing,
                   "Let models that are affine copies of another one share its structure and vertices");
}

}  // namespace

void add_run(Command app, Session& session) {
  auto options = std::make_shared<RunOptions>();
  Command command =
      app.add_subcommand("run", "Render a scene, or launch a pipeline or a PTX kernel, on the simulated GPU");
  add_scene_options(command, *options);
  add_launch_options(command, options->launch);
  command.add_option("--progress-fd", session.progress_descriptor, "Descriptor to write the progress to")
      .group("");             // Only `bench` uses it.
  command.last_value_wins();  // so that a script's own options can be overridden on the command line
  command.callback([&session, options, command] {
    finish_launch_options(command, options->launch);
    options->scene.shader_given = command.count("--shader") > 0;
    options->scene.sequence.caches = options->caches;
    options->of_one_kind = given_of_one_kind(command);
    if (!options->caches.empty()) options->script.caches = options->caches;
    session.check = [options] { check(*options); };
    session.action = [&session, options] { return run(session, *options); };
  });
}

}  // namespace glint::app
