// Declares the options that every kind of launch takes.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/launch_options.h"

#include "apps/glint/options/config.h"
#include "apps/glint/options/observe_options.h"

namespace glint::app {
namespace {

void add_machine_options(Command command, LaunchOptions& options) {
  command.add_option("--config", options.config, "Preset or TOML file").capture_default_str();
  command.add_option("--set", options.settings, "Override of a key, repeatable: core.warps=16")
      .type_name("KEY=VALUE")
      .allow_extra_args(false);
  command.add_option("--mode", options.mode, "timing: cycle by cycle; functional: picture and counts only")
      .one_of({"timing", "functional"})
      .capture_default_str();
  command
      .add_option("--max-instructions", options.max_instructions,
                  "Instructions after which a warp is taken to have no end")
      .positive();
  command
      .add_option("--on-fault", options.on_fault_name,
                  "stop: the first fault ends the run; warn: wrong loads give 0, wrong stores do nothing, "
                  "and each is listed (docs/errors.md)")
      .one_of({"stop", "warn"})
      .capture_default_str();
  command.add_flag("--no-skip", options.no_skip, "Step every cycle: slow, same result, for checking");
  command
      .add_option("--threads", options.threads,
                  "Threads of the timing machine, same result with any number; 0: all processors, while "
                  "they are faster than one")
      .in_range(0u, 256u)
      .capture_default_str();
}

}  // namespace

void add_launch_options(Command command, LaunchOptions& options) {
  add_machine_options(command, options);
  command.add_option("--out", options.out, "Run directory (default: out/SCENE_SHADER-MODE)").type_name("DIR");
  command.add_flag("--json", options.json, "Print the statistics as JSON instead of the summary");
  command
      .add_option("--printf-limit", options.print_limit,
                  "Messages of debugPrintfEXT to show, the first by launch id")
      .capture_default_str();
  add_observe_options(command, options.observe);
  add_shader_options(command, options.shaders);
}

void finish_launch_options(const Command& command, LaunchOptions& options) {
  options.config_given = command.count("--config") > 0;
  options.mode_given = command.count("--mode") > 0;
  options.on_fault = options.on_fault_name == "warn" ? exec::OnFault::Warn : exec::OnFault::Stop;
  if (options.shaders.contract) options.settings.push_back("compiler.contract=true");
}

pipeline::GpuParams gpu_of(const Resources& resources, const LaunchOptions& options) {
  pipeline::GpuParams gpu = read_config(resources, options.config, options.settings);
  if (options.max_instructions > 0) gpu.core.instruction_budget = options.max_instructions;
  return gpu;
}

}  // namespace glint::app
