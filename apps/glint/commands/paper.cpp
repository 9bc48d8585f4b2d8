// Declares `glint paper`, which hands its command line to the Python package: it runs this program many
// times.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/python_package.h"
#include "apps/glint/session.h"

namespace glint::app {
namespace {

// Only their rules count here. The package reads the same words again (python/glint/paper/command.py), and a
// test compares the two lists.
struct PaperOptions {
  std::string assets, size = "128x128", out = "out/paper", python = "python3";
  std::vector<std::string> workloads, programs;
  uint32_t jobs = 0, spp = 2;
  bool subset = false, list = false, report = false, small = false;
};

void add_options(Command command, PaperOptions& options) {
  command.add_flag("--subset", options.subset,
                   "The short form: the paper's eight workloads instead of all 46, and no ablation");
  command.add_flag("--list", options.list, "Print what would be run, with what is complete, and run nothing");
  command.add_flag("--report", options.report, "Write the report of what is complete, and run nothing more");
  add_jobs_option(command, options.jobs);
  add_assets_option(command, options.assets, ": everything is run with it, too");
  command
      .add_option("--out", options.out,
                  "Folder for runs, analysis and report; what is complete there is not run again")
      .type_name("DIR")
      .capture_default_str();
  command.add_option("--size", options.size, "Image size in pixels").type_name("WxH").capture_default_str();
  command.add_option("--spp", options.spp, "Samples per pixel").in_range(1u, 65536u).capture_default_str();
  command.add_option("--workloads", options.workloads,
                     "For a trial: workloads that stand for all, in small frames");
  command.add_option("--programs", options.programs, "For a trial: compute programs that stand for all");
  command.add_flag("--small", options.small, "Run compute programs on their small inputs");
  add_python_option(command, options.python);
}

}  // namespace

void add_paper(Command app, Session& session) {
  auto options = std::make_shared<PaperOptions>();
  Command command = app.add_subcommand(
      "paper", "Run what the LumiBench paper shows, and write a report with its figures and statements");
  add_options(command, *options);
  command.callback([&session, options] {
    session.action = [&session, options] {
      return hand_over(session, options->python, "glint.paper", "paper");
    };
  });
}

}  // namespace glint::app
