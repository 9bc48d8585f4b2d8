// Declares `glint stats RUN`, which prints the statistics of a finished run again, in any format.
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/run_files.h"
#include "apps/glint/session.h"
#include "report/files/file_list.h"
#include "report/files/run_record.h"
#include "report/metrics/metrics.h"
#include "report/metrics/vulkan_sim.h"

namespace glint::app {
namespace {

Exit stats(const std::string& run, const std::string& format) {
  if (format == "metrics") {
    write_output("", report::metrics_text(report::RunRecord::read(run)));
  } else if (format == "vulkan-sim") {
    write_output("", report::vulkan_sim_text(report::RunRecord::read(run)));
  } else {
    report::check_finished(run);
    if (format != "csv") report::check_full_statistics(run, "the format " + format);
    write_output("", report::ListedFiles::of_run(run).need("stats." + format));
  }
  tell_of_files({run});
  return Exit::Ok;
}

}  // namespace

void add_stats(Command app, Session& session) {
  struct Options {
    std::string run, format = "txt";
  };
  auto options = std::make_shared<Options>();
  Command command = app.add_subcommand("stats", "Print the statistics of a finished run");
  command.add_option("RUN", options->run, "Directory of the run").required();
  command
      .add_option("--format", options->format,
                  "Selects the format: txt, csv and json print what the run wrote, metrics prints the "
                  "metrics of docs/metrics.md, and vulkan-sim uses the names of Vulkan-Sim's logs")
      .one_of({"txt", "csv", "json", "metrics", "vulkan-sim"})
      .capture_default_str();
  command.callback(
      [&session, options] { session.action = [options] { return stats(options->run, options->format); }; });
}

}  // namespace glint::app
