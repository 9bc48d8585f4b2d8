// Declares the options that every kind of launch takes.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/launch_options.h"

#include <cstdint>

#include "apps/glint/options/config.h"
#include "apps/glint/options/observe_options.h"
#include "setup/oracles.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

constexpr uint64_t kMostCount = 1'000'000'000'000'000'000;  // more than any run reaches

void add_machine_options(Command command, LaunchOptions& options) {
  command.add_option("--config", options.config, "Preset or TOML file to read").capture_default_str();
  command.add_option("--set", options.settings, "Override one key, such as core.warps=16; repeatable")
      .type_name("KEY=VALUE")
      .allow_extra_args(false);
  add_oracle_option(command, options.oracles);
  command
      .add_option(
          "--mode", options.mode,
          "Selects the machine: timing runs cycle by cycle, functional gives only the picture and counts")
      .one_of({"timing", "functional"})
      .capture_default_str();
  command
      .add_option("--max-instructions", options.max_instructions,
                  "Number of instructions after which a warp is taken to be endless")
      .in_range(uint64_t{1}, kMostCount);
  add_max_cycles_option(
      command, options.max_cycles,
      "Cycle at which the launch is ended early; what it did up to then is kept, and the exit "
      "code is 6 (default: no limit)");
  command
      .add_option("--on-fault", options.on_fault_name,
                  "Selects what a fault does: stop ends the run at the first fault; with warn, wrong loads "
                  "give 0, wrong stores do nothing, and each is listed (docs/errors.md)")
      .one_of({"stop", "warn"})
      .capture_default_str();
  command.add_flag("--no-skip", options.no_skip,
                   "Step through every cycle, which is slow and gives the same result, to check skipping");
  command
      .add_option("--threads", options.threads,
                  "Number of host threads, which does not change results; 0: one for each processor that the "
                  "command may use, or fewer where the timing machine is faster with fewer")
      .in_range(0u, 256u)
      .capture_default_str();
}

}  // namespace

void add_stats_option(Command command, std::string& stats) {
  command
      .add_option("--stats", stats,
                  "Selects the statistics to write: full has every unit, in three formats; compact has "
                  "totals over units in stats.csv, from which all metrics follow, and makes a run of at most "
                  "60 kB without its pictures")
      .one_of({"full", "compact"})
      .capture_default_str();
}

void add_max_cycles_option(Command command, uint64_t& max_cycles, const std::string& help) {
  command.add_option("--max-cycles", max_cycles, help).type_name("CYCLES").positive();
}

void add_launch_options(Command command, LaunchOptions& options) {
  add_machine_options(command, options);
  command
      .add_option("--out", options.out,
                  "New or empty directory, or that of an earlier run, to write the run to (default: "
                  "out/SCENE_SHADER-MODE)")
      .type_name("DIR");
  add_stats_option(command, options.stats);
  command.add_flag("--json", options.json, "Print the statistics as JSON instead of the summary");
  command
      .add_option("--printf-limit", options.print_limit,
                  "Number of debugPrintfEXT messages to show, the first by launch id")
      .in_range(uint64_t{0}, kMostCount)
      .capture_default_str();
  add_observe_options(command, options.observe);
  add_sample_options(command, options.sample);
  add_shader_options(command, options.shaders);
}

void finish_launch_options(const Command& command, LaunchOptions& options) {
  options.config_given = command.count("--config") > 0;
  options.mode_given = command.count("--mode") > 0;
  options.on_fault = options.on_fault_name == "warn" ? exec::OnFault::Warn : exec::OnFault::Stop;
  options.sample.note_given(command);
  options.settings = setup::with_oracles(options.oracles, options.settings);
  if (options.shaders.contract) options.settings.push_back("compiler.contract=true");
}

void check_sample(const LaunchOptions& options) {
  check_sample_options(options.sample);
  const std::string given = options.sample.given();
  if (given.empty()) return;
  const auto refuse = [&](const std::string& option, const std::string& why) {
    throw UserError({}, given + " cannot be used with " + option, why);
  };
  if (options.mode != "timing")
    refuse("--mode functional", "the functional machine has no cycles, so run the whole launch");
  if (observes(options.observe))
    refuse("--profile, --sample, --heat and --trace",
           "they show every block of a launch; leave " + given + " away to run all of them");
  if (options.max_cycles) refuse("--max-cycles", "an estimate needs the sample's end");
}

void check_max_cycles(uint64_t max_cycles, bool timing) {
  if (max_cycles && !timing)
    throw UserError({}, "--max-cycles needs cycles, and the functional machine has none",
                    "--max-instructions bounds the instructions of a warp");
}

pipeline::GpuParams gpu_of(const setup::Resources& resources, const LaunchOptions& options) {
  pipeline::GpuParams gpu = read_config(resources, options.config, options.settings);
  if (options.max_instructions > 0) gpu.core.instruction_budget = options.max_instructions;
  return gpu;
}

}  // namespace glint::app
