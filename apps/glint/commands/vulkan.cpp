// Declares `glint vulkan -- PROGRAM`, which runs a Vulkan program on Glint's driver.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "apps/glint/run/launch_options.h"
#include "apps/glint/run/vulkan_program.h"
#include "apps/glint/session.h"

namespace glint::app {
namespace {

// Returns the words after "--" as they are. The command line's parser takes "[a]" for a list.
std::vector<std::string> program_of(const Session& session, const std::vector<std::string>& parsed) {
  const auto mark = std::find(session.arguments.begin(), session.arguments.end(), "--");
  return mark == session.arguments.end() ? parsed : std::vector(mark + 1, session.arguments.end());
}

// Adds what the driver does besides running launches.
void add_driver_options(Command command, VulkanProgram& options) {
  command
      .add_option(
          "--queue", options.queue,
          "Selects what the device says of its queue: universal pretends to have graphics, for programs "
          "that want it and then only compute")
      .one_of({"compute", "universal"})
      .capture_default_str();
  command
      .add_option("--present", options.present,
                  "Selects the presented frames that are written as PNG: all, last, none or 'frame 0,7-9'")
      .type_name("FRAMES")
      .capture_default_str();
  command
      .add_option("--save", options.save,
                  "Launches to save as capsules, which 'glint run' runs again on any machine; chosen as "
                  "for --timing (default: none)")
      .type_name("CHOICE");
}

}  // namespace

void add_vulkan(Command app, Session& session) {
  auto options = std::make_shared<VulkanProgram>();
  options->config = "mobile";
  Command command =
      app.add_subcommand("vulkan", "Run a Vulkan program, unmodified, on the simulated GPU (docs/vulkan.md)");
  command
      .add_option("PROGRAM", options->command,
                  "Program to run, after --, with its arguments: glint vulkan --timing all -- ./program -x")
      .required();
  command
      .add_option(
          "--timing", options->timing,
          "Launches to run cycle by cycle: all, none, launch 3, dispatch 0,7-9, trace 2, first 1 (of each "
          "pipeline), frame 5, label:NAME, shader:NAME; ';' joins several (default: none)")
      .type_name("CHOICE");
  command.add_option("--config", options->config, "Preset or TOML file to read").capture_default_str();
  command.add_option("--set", options->settings, "Override one key, such as core.warps=16; repeatable")
      .type_name("KEY=VALUE")
      .allow_extra_args(false);
  command
      .add_option(
          "-o,--out", options->out,
          "New or empty folder for run directories, index.json and report (default: out/vulkan-PROGRAM)")
      .type_name("DIR");
  command
      .add_option(
          "--on-fault", options->on_fault,
          "Selects what a fault does: with warn, wrong loads give 0 and wrong stores do nothing; stop "
          "loses the device at the first fault")
      .one_of({"warn", "stop"})
      .capture_default_str();
  add_driver_options(command, *options);
  command.add_option("--threads", options->threads, "Number of host threads, which does not change results")
      .in_range(1u, 256u)
      .capture_default_str();
  add_stats_option(command, options->stats);
  command.add_flag("--profile", options->profile,
                   "Count timed launches by instruction and source line, for 'glint annotate'");
  command.add_option("--sample", options->sample, "Write series.csv of timed launches with such intervals")
      .type_name("CYCLES")
      .positive();
  command.add_flag("--heat", options->heat, "Write maps of what each pixel of timed launches cost");
  command.add_flag("--trace", options->trace, "Write trace.json.gz of timed launches for Perfetto");
  command.add_flag("--no-report", options->no_report, "Write no report.html at the end");
  command.callback([&session, options] {
    options->command = program_of(session, options->command);
    session.action = [&session, options] { return run_vulkan_program(session, *options); };
  });
}

}  // namespace glint::app
