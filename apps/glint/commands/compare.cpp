// Declares `glint compare A B`, which prints what changed from one run to another, with an exit code for
// scripts.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/compare.h"

#include <fmt/format.h>
#include <memory>

#include "apps/glint/options/run_files.h"
#include "apps/glint/session.h"
#include "report/files/file_list.h"
#include "report/metrics/compare_causes.h"

namespace glint::app {
namespace {

std::string config_of(const std::string& directory) {
  return report::ListedFiles::of_run(directory).need("config.toml");
}

Exit compare(const std::string& before, const std::string& after, const std::vector<std::string>& fail_on,
             bool all) {
  std::vector<report::Condition> conditions;
  for (const std::string& text : fail_on) conditions.push_back(report::parse_condition(text));
  const report::RunRecord was = report::RunRecord::read(before), is = report::RunRecord::read(after);
  const std::vector<report::Change> changes = report::changes(was, is);
  tell_of_files({before, after});
  write_output("", report::changes_text(changes, all) + report::uncompared_text(was, is) +
                       report::changed_keys_text(config_of(before), config_of(after)) +
                       report::changed_stalls_text(was, is, all));
  Exit exit = Exit::Ok;
  for (const report::Condition& condition : conditions) {
    if (!report::holds(condition, changes)) continue;
    fmt::print(stderr, "failed: {}\n", condition.text);
    exit = Exit::Failure;
  }
  return exit;
}

}  // namespace

void add_compare(Command app, Session& session) {
  struct Options {
    std::string before, after;
    std::vector<std::string> fail_on;
    bool all = false;
  };
  auto options = std::make_shared<Options>();
  Command command = app.add_subcommand("compare", "Print what changed from one finished run to another");
  command.add_option("A", options->before, "Directory of the run before the change").required();
  command.add_option("B", options->after, "Directory of the run after the change").required();
  command
      .add_option("--fail-on", options->fail_on,
                  "Exit with 1 when a metric changed by less or more than this, such as 'ipc<-2%' or "
                  "'cycles>1%'; repeatable")
      .allow_extra_args(false);
  command.add_flag("--all", options->all, "Print metrics that did not change, too");
  command.callback([&session, options] {
    session.action = [options] {
      return compare(options->before, options->after, options->fail_on, options->all);
    };
  });
}

}  // namespace glint::app
