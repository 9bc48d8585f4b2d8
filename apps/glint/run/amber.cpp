// Runs scripts one after the other, counts their results, and leaves run directories where they are wanted.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/amber.h"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <utility>
#include <vector>

#include "amber/run.h"
#include "apps/glint/options/observe_options.h"
#include "apps/glint/options/output.h"
#include "apps/glint/run/launch_list.h"
#include "apps/glint/run/recorded_run.h"
#include "report/files/config_file.h"
#include "report/files/run_directory.h"
#include "setup/recorded_launch.h"

namespace glint::app {
namespace {

// Adds the names of the pipelines that the commands launch, in order, unless an expectation fails before.
void add_launches(const std::vector<amber::Command>& commands, std::vector<std::string>& names) {
  for (const amber::Command& command : commands) {
    const auto& [x, y, z] = command.size;
    if (command.kind == amber::Command::Kind::Run && x > 0 && y > 0 && z > 0)
      names.push_back(command.pipeline);
    if (command.kind == amber::Command::Kind::Repeat)
      for (uint32_t i = 0; i < command.count; ++i) add_launches(command.body, names);
  }
}

// Returns the hash of what the script's launches begin with.
uint64_t hash_of(const amber::Script& script) {
  std::string everything;
  for (const auto& [name, shader] : script.shaders) everything += shader.text;
  for (const auto& [name, buffer] : script.buffers)
    everything.append(reinterpret_cast<const char*>(buffer.bytes.data()), buffer.bytes.size());
  return report::fnv1a(everything);
}

// Runs a script and leaves a run directory in `out`, with one of each launch inside. Its exit code is that of
// the script, or says that a signal has ended a launch.
amber::Outcome run_script_recorded(const Session& session, const LaunchOptions& options,
                                   amber::LaunchOptions launch, amber::Script script,
                                   const std::string& out) {
  report::RunDirectory directory(out);
  report::RunInfo info =
      new_run_info(session, launch.gpu, options.config, launch.mode.timing ? "timing" : "functional");
  info.scene = std::filesystem::path(script.path).stem().string(), info.scene_form = "script";
  info.scene_hash = hash_of(script);
  info.on_fault = exec::name_of(options.on_fault), info.compact = options.compact();
  std::vector<std::string> names;
  add_launches(script.commands, names);
  info.launches = launch_folders(names);
  setup::begin_directory(
      directory, info, launch.gpu,
      fmt::format("{}  {} launches, {} on {}", info.scene, names.size(), info.mode, info.config));

  LaunchRecorder recorder(options, launch.gpu, directory, info);
  launch.record = [&](const amber::ScriptLaunch& each, const std::function<pipeline::RenderResult()>& run) {
    recorder.record(each.pipeline, each.shaders, each.world, run, launch.prints);
  };
  amber::Outcome outcome;
  const auto run = [&](const pipeline::LaunchWatch& watch) {
    launch.watch = watch;
    outcome = amber::run_script(std::move(script), launch);
    return std::move(recorder.sum());
  };
  const auto keep = [&](const pipeline::RenderResult& sum) {
    info.launches.resize(recorder.num_begun());  // An expectation that fails ends a script.
    if (!info.part) info.exit = int(outcome.exit), info.message = outcome.message;
    if (recorder.num_ended() > 0) directory.write_stats(sum.statistics(), info.compact);
  };
  run_recorded(session, 0, directory, info, run, keep);
  if (info.part) outcome.exit = Exit(info.exit), outcome.message = info.message;
  for (const std::string& line : recorder.lines()) print_output("{}\n", line);
  return outcome;
}

// Returns the folder of the script's run: that of --out, or for several scripts one inside it that has the
// name of the script, and a number where another script has the same name.
std::string folder_of(const std::string& out, const std::vector<std::string>& scripts, size_t index) {
  if (scripts.size() == 1) return out;
  const auto stem = [&](size_t i) { return std::filesystem::path(scripts[i]).stem().string(); };
  size_t same = 1;
  for (size_t i = 0; i < index; ++i) same += stem(i) == stem(index);
  return fmt::format("{}/{}{}", out, stem(index), same > 1 ? fmt::format("-{}", same) : "");
}

amber::Outcome run_one(const Session& session, const LaunchOptions& options,
                       const amber::LaunchOptions& launch, const std::vector<std::string>& scripts,
                       size_t index) {
  if (options.out.empty()) return amber::run_script(scripts[index], launch);
  amber::Script script;
  try {
    script = amber::read_script(scripts[index]);
  } catch (const Error& error) {
    amber::Outcome outcome;
    note(outcome, error);
    return outcome;
  }
  return run_script_recorded(session, options, launch, std::move(script),
                             folder_of(options.out, scripts, index));
}

}  // namespace

bool names_script(const std::string& what) {
  return what.ends_with(".amber");
}

Exit run_amber(const Session& session, const std::vector<std::string>& scripts, const LaunchOptions& options,
               const ScriptOptions& script_options) {
  for (const std::string& path : scripts)
    if (!names_script(path))
      throw UserError({}, fmt::format("'{}' is not an Amber script", path),
                      "several names on one command line must all be FILE.amber");
  const bool timing = options.mode_given && options.mode == "timing", warm = script_options.caches == "warm";
  if (observes(options.observe) && options.out.empty())
    throw UserError({}, "--profile, --sample, --heat and --trace of an Amber script need a run directory",
                    "--out names it");
  check_observation(options.observe, timing);
  if (warm && !timing)
    throw UserError({}, "--caches warm needs the timing machine, and Amber scripts run functionally",
                    "--mode timing runs them cycle by cycle");
  amber::LaunchOptions launch;
  launch.gpu = gpu_of(session.resources, options);
  launch.mode = {timing, options.no_skip, options.threads,
                 warm ? pipeline::Caches::Warm : pipeline::Caches::Cold, options.observe};
  launch.on_fault = options.on_fault, launch.strict = script_options.strict;
  const std::unique_ptr<frontend::ShaderCache> cache = open_shader_cache(options.shaders);
  exec::PrintLog prints(options.print_limit);
  launch.cache = cache.get(), launch.prints = &prints;

  uint32_t counts[3] = {};
  Exit exit = Exit::Ok;
  for (size_t i = 0; i < scripts.size(); ++i) {
    const amber::Outcome outcome = run_one(session, options, launch, scripts, i);
    ++counts[size_t(outcome.verdict)];
    fmt::print(stderr, "{}", outcome.printed);
    for (const std::string& faults : outcome.faults) fmt::print(stderr, "{}\n", faults);
    if (outcome.verdict != amber::Verdict::Passed) fmt::print(stderr, "{}\n", outcome.message);
    if (scripts.size() == 1) exit = outcome.exit;
    if (timing && outcome.verdict == amber::Verdict::Passed)
      print_output("{}: {} cycles\n", scripts[i], outcome.cycles);
  }
  print_output("{} passed, {} failed, {} unsupported\n", counts[0], counts[1], counts[2]);
  if (scripts.size() > 1) exit = counts[1] ? Exit::Failure : counts[2] ? Exit::Unsupported : Exit::Ok;
  return exit;
}

}  // namespace glint::app
