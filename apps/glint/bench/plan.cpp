// Plans a suite.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench/plan.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "apps/glint/bench/estimate.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/launch_options.h"
#include "base/regular_file.h"
#include "report/files/config_file.h"
#include "report/files/run_directory.h"
#include "report/files/run_facts.h"
#include "report/files/run_record.h"
#include "scenes/scene.h"
#include "setup/build_commit.h"
#include "setup/resources.h"

namespace glint::app {
namespace {
namespace fs = std::filesystem;

constexpr const char* kMark = "workload.json";

std::string bytes_of(const std::string& path) {
  return setup::text_of_file(path).value_or("");
}

// Returns everything that a result depends on. Two runs of the same key give the same statistics.
std::string key_of(const Session& session, const BenchOptions& options) {
  const pipeline::GpuParams gpu = read_config(session.resources, options.config, options.settings);
  const std::string text = fmt::format(
      "config {:016x} mode {} frame {} assets '{}' version {} {} program {:016x} shaders {:016x}{}{} "
      "stats {} small {} sample {} {} {} {}",
      report::fnv1a(report::config_key_values(describe_params(gpu))), options.mode,
      fmt::join(options.frame.arguments(), " "),
      options.assets.empty() ? "" : fs::weakly_canonical(options.assets).string(), GLINT_VERSION,
      setup::build_commit(), report::fnv1a(bytes_of("/proc/self/exe")), hash_of_shaders(session.resources),
      identity_of(session.plugins), fmt::join(observe_arguments(options.observe), " "), options.stats,
      options.small, options.sample.share, options.sample.by, options.sample.launches, options.sample.seed);
  return fmt::format("{:016x}", report::fnv1a(text));
}

nlohmann::json mark_of(const BenchTask& task) {
  const std::string text = read_regular_file(task.directory + "/" + kMark).value_or("");
  return nlohmann::json::parse(text, nullptr, false);
}

bool is_complete(const BenchTask& task, const std::string& key) {
  const nlohmann::json mark = mark_of(task);
  if (!mark.is_object() || !mark.contains("key") || mark["key"] != key) return false;
  for (const char* name : {"wall_seconds", "peak_bytes"})
    if (!mark.contains(name) || !mark[name].is_number()) return false;
  try {
    report::RunRecord::read(task.directory);
    return true;
  } catch (const UserError&) {  // A run that is damaged or gone is not complete.
    return false;
  }
}

bool has_launches(const NamedWorkload& workload) {
  return workload.is_program() || !workload.frames.empty();
}

// Returns the options of `glint run` that sample the workload; none where it runs whole.
std::vector<std::string> sample_arguments(const SampleChoice& sample, const NamedWorkload& workload) {
  std::vector<std::string> out;
  if (has_launches(workload) && sample.wants_launches())
    out = {"--sample-launches=" + sample.launches};
  else if (!has_launches(workload) && sample.wants_pixels())
    out = {"--sample-pixels=" + sample.share, "--sample-by=" + sample.by};
  if (!out.empty()) out.push_back(fmt::format("--sample-seed={}", sample.seed));
  return out;
}

std::vector<std::string> command_of(const Session& session, const BenchOptions& options,
                                    const BenchTask& task) {
  std::vector<std::string> out = {"run",
                                  task.workload.name(),
                                  "--config=" + options.config,
                                  "--mode=" + options.mode,
                                  fmt::format("--threads={}", options.threads),
                                  "--out=" + task.directory};
  for (const Plugin& plugin : session.plugins) out.push_back("--plugin=" + plugin.path);
  if (!task.workload.is_program())
    for (const std::string& option : options.frame.arguments()) out.push_back(option);
  else if (options.small)
    out.push_back("--small");
  out.push_back("--stats=" + options.stats);
  if (options.max_cycles > 0) out.push_back(fmt::format("--max-cycles={}", options.max_cycles));
  for (const std::string& option : observe_arguments(options.observe)) out.push_back(option);
  for (const std::string& option : sample_arguments(options.sample, task.workload)) out.push_back(option);
  for (const std::string& setting : options.settings) out.push_back("--set=" + setting);
  if (!options.assets.empty()) out.push_back("--assets=" + options.assets);
  return out;
}

// Refuses a sample together with what needs whole launches.
void check_sampled(const BenchOptions& options) {
  check_sample_forms(options.sample);
  const std::string given = options.sample.given();
  if (given.empty()) return;
  if (options.mode != "timing")
    throw UserError({}, given + " cannot be used with --mode functional",
                    "the functional machine has no cycles, so run the whole launches");
  if (observes(options.observe) || options.max_cycles)
    throw UserError({}, given + " cannot be used with --profile, --sample, --heat, --trace and --max-cycles",
                    "they need whole launches");
}

// Refuses options that have no meaning for any or for one of the workloads.
void check_kinds(const BenchOptions& options, const std::vector<NamedWorkload>& workloads) {
  const auto programs = std::count_if(workloads.begin(), workloads.end(),
                                      [](const NamedWorkload& workload) { return workload.is_program(); });
  if (options.small && programs == 0)
    throw UserError({}, "--small belongs to compute programs, and the bench has none",
                    "`glint bench compute --small` runs them all");
  if (const std::string given = options.frame.given(); !given.empty() && programs == ssize(workloads))
    throw UserError({}, given + " belongs to scenes, and the bench has none",
                    "compute programs have a full input, and a small one with --small");
  const auto frames = std::ranges::count_if(workloads, has_launches) - programs;
  if (options.sample.wants_launches() && programs + frames == 0)
    throw UserError({},
                    "--sample-launches belongs to compute programs and to workloads of several frames, and "
                    "the bench has none",
                    "--sample-pixels samples the others");
  if (options.sample.wants_pixels() && programs + frames == ssize(workloads))
    throw UserError({}, "--sample-pixels belongs to workloads of one frame, and the bench has none",
                    "--sample-launches samples programs and workloads of several frames");
  if (observes(options.observe) && programs > 0)
    throw UserError({}, "--profile, --sample, --heat and --trace cannot be used with compute programs",
                    "they belong to one launch, and a program may have many");
}

void estimate(const BenchOptions& options, uint64_t pixels, uint64_t samples, BenchTask& task) {
  const bool timing = options.mode == "timing";
  if (task.workload.is_program()) {
    const compute::Program& program = *compute::find_program(task.workload.scene);
    task.process.memory = memory_estimate(program, options.small);
    task.process.weight = time_weight(program, options.small, timing);
  } else {
    task.process.memory = memory_estimate(task.workload, pixels, !options.assets.empty());
    task.process.weight = time_weight(task.workload, timing, pixels, samples);
  }
}

}  // namespace

uint64_t hash_of_shaders(const setup::Resources& resources) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(resources.shader_dir("")))
    if (entry.is_regular_file()) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  std::string all;
  for (const std::string& file : files) all += fs::path(file).filename().string() + "\n" + bytes_of(file);
  return report::fnv1a(all);
}

BenchPlan plan_bench(const Session& session, const BenchOptions& options) {
  check_observation(options.observe, options.mode == "timing");
  check_max_cycles(options.max_cycles, options.mode == "timing");
  check_sampled(options);
  BenchPlan plan;
  const scenes::RenderParams frame = options.frame.frame();
  options.frame.overrides();  // Texts that are none of a scene are told before anything runs.
  const std::vector<std::string> names =
      options.names.empty() ? std::vector<std::string>{"lumibench"} : options.names;
  const std::vector<NamedWorkload> workloads = select_workloads(names);
  check_kinds(options, workloads);
  plan.key = key_of(session, options);
  plan.directory =
      options.out.empty() ? "out/bench-" + fs::path(options.config).stem().string() : options.out;
  const uint64_t pixels = uint64_t{frame.width} * frame.height;
  for (const NamedWorkload& workload : workloads) {
    if (!workload.is_program() && !scenes::has_original(std::string(workload.scene), options.assets)) {
      plan.left_out.push_back(workload.name());
      continue;
    }
    BenchTask task{workload, plan.directory + "/" + workload.name(), {}};
    task.process.arguments = command_of(session, options, task);
    task.process.log = task.directory + "/log.txt";
    estimate(options, pixels, frame.samples, task);
    task.is_complete = options.resume && is_complete(task, plan.key);
    plan.tasks.push_back(std::move(task));
  }
  if (plan.tasks.empty())
    throw UserError(
        {}, fmt::format("no workload has a scene with files in the assets folder '{}'", options.assets),
        "without an assets folder the scenes are built in");
  return plan;
}

void mark_complete(const BenchTask& task, const std::string& key, const Process& process) {
  const nlohmann::ordered_json mark = {{"workload", task.workload.name()},
                                       {"key", key},
                                       {"wall_seconds", process.seconds},
                                       {"peak_bytes", process.peak_bytes}};
  report::RunDirectory(task.directory).write(kMark, mark.dump(2) + "\n");
}

void unmark(const BenchTask& task) {
  std::error_code ignored;  // The file may not exist.
  fs::remove(task.directory + "/" + kMark, ignored);
}

void read_mark(const BenchTask& task, Process& process) {
  const nlohmann::json mark = mark_of(task);
  if (!mark.is_object()) return;
  process.state = Process::State::Done;
  process.seconds = mark.value("wall_seconds", 0.0);
  process.peak_bytes = mark.value("peak_bytes", uint64_t{0});
}

}  // namespace glint::app
