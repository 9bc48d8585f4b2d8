// Declares `glint bench [NAMES...]`, which runs workloads as processes and gathers their metrics.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench/bench.h"

#include <memory>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/frame_options.h"
#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"
#include "setup/oracles.h"

namespace glint::app {

void add_bench(Command app, Session& session) {
  auto options = std::make_shared<BenchOptions>();
  Command command =
      app.add_subcommand("bench", "Run workloads of LumiBench or compute programs, and gather their metrics");
  command.add_option(
      "NAMES", options->names,
      "What to run: lumibench (all 46, the default), subset (8), lumibench-motion (3, of several frames), "
      "compute (all programs), a scene, pt, sh, ao, workloads or programs; 'glint list workloads' and 'glint "
      "list programs' "
      "name them");
  command.add_flag("--small", options->small, "Run compute programs on their small inputs");
  add_jobs_option(command, options->processes);
  command.add_flag(
      "--resume", options->resume,
      "Leave out workloads that were completed with the same configuration, options, program and shaders");
  command
      .add_option("--memory", options->memory,
                  "GB of memory that all processes may take together (default: what is available)")
      .number_range(0.001, 1e6);
  command.add_option("--config", options->config, "Preset or TOML file to read").capture_default_str();
  command.add_option("--set", options->settings, "Override one key, such as core.warps=16; repeatable")
      .type_name("KEY=VALUE")
      .allow_extra_args(false);
  add_oracle_option(command, options->oracles);
  command
      .add_option(
          "--mode", options->mode,
          "Selects the machine: timing runs cycle by cycle, functional gives only the picture and counts")
      .one_of({"timing", "functional"})
      .capture_default_str();
  add_assets_option(command, options->assets);
  command
      .add_option(
          "--out", options->out,
          "Folder to write the results to, with a folder for each workload (default: out/bench-CONFIG)")
      .type_name("DIR");
  command.add_option("--threads", options->threads, "Threads of each process")
      .in_range(0u, 256u)
      .capture_default_str();
  add_frame_options(command, options->frame);
  add_observe_options(command, options->observe);
  add_sample_options(command, options->sample);
  add_stats_option(command, options->stats);
  add_max_cycles_option(
      command, options->max_cycles,
      "Cycle at which each launch is ended early; its row of the summary is marked as partial, "
      "metrics.csv does not have it, and the exit code is 6 (default: no limit)");
  command.callback([&session, options, command] {
    session.action = [&session, options, command] {
      options->settings = setup::with_oracles(options->oracles, options->settings);
      options->sample.note_given(command);
      return run_bench(session, *options);
    };
  });
}

}  // namespace glint::app
