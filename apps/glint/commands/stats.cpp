// `glint stats RUN`: the statistics of a finished run again, in any format, as metrics, or by Vulkan-Sim's
// names.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include "apps/glint/options/command_line.h"
#include "apps/glint/session.h"
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
    const std::string path = run + "/stats." + format;
    if (!std::filesystem::exists(path))
      throw UserError({path}, "there is no such file", "is this the directory of a finished run?");
    write_output("", read_file(path));
  }
  return Exit::Ok;
}

}  // namespace

void add_stats(Command app, Session& session) {
  struct Options {
    std::string run, format = "txt";
  };
  auto options = std::make_shared<Options>();
  Command command = app.add_subcommand("stats", "Print the statistics of a finished run");
  command.add_option("RUN", options->run, "Run directory").required();
  command
      .add_option("--format", options->format,
                  "txt, csv, json: as the run wrote them; metrics: those of docs/metrics.md; vulkan-sim: "
                  "under the names of its logs")
      .one_of({"txt", "csv", "json", "metrics", "vulkan-sim"})
      .capture_default_str();
  command.callback(
      [&session, options] { session.action = [options] { return stats(options->run, options->format); }; });
}

}  // namespace glint::app
