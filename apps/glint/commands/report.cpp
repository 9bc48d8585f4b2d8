// Declares `glint report RUN...`, which writes one HTML page of finished runs and of what is known of suites.
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/observe_options.h"
#include "apps/glint/options/report_writer.h"
#include "apps/glint/session.h"

namespace glint::app {

void add_report(Command app, Session& session) {
  struct Options {
    std::vector<std::string> runs;
    std::string out;
    report::TimelineRequest timeline;
  };
  auto options = std::make_shared<Options>();
  Command command = app.add_subcommand("report", "Write a page of figures about finished runs");
  command
      .add_option(
          "RUN", options->runs,
          "What to report: run directories, folders of sweeps, folders of `glint lab`, folders of `glint "
          "bench` with what `glint "
          "characterize` and `glint model` have left there, or folders and tables of these two alone. With "
          "several "
          "runs, figures stand side by side and changes are against the first")
      .required();
  command.add_option(
      "-o,--out", options->out,
      "File to write, or - for stdout (default: report.html in the named directory, or here with several)");
  add_cycle_window(command, "--timeline",
                   "Cycles that the warp timeline of a run with --trace shows (default: as many around the "
                   "middle of the trace as stay readable)",
                   options->timeline.begin, options->timeline.end);
  command.add_option("--timeline-sm", options->timeline.core, "SM that the warp timeline shows")
      .capture_default_str();
  command.callback([&session, options, command] {
    std::optional<report::TimelineRequest> timeline;
    if (command.count("--timeline") + command.count("--timeline-sm") > 0) timeline = options->timeline;
    session.action = [&session, options, timeline] {
      return write_report(session, options->runs, options->out, timeline);
    };
  });
}

}  // namespace glint::app
