// Declares `glint compare A B`, which prints what changed from one run to another, with an exit code for
// scripts.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/compare.h"

#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <system_error>

#include "apps/glint/bench/tables.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/run_files.h"
#include "apps/glint/session.h"
#include "base/diagnostics.h"
#include "report/files/file_list.h"
#include "report/metrics/compare_causes.h"
#include "report/metrics/compare_samples.h"

namespace glint::app {
namespace {

struct CompareOptions {
  std::string before, after;
  std::vector<std::string> fail_on;
  bool all = false;
};

std::string config_of(const std::string& directory) {
  return report::ListedFiles::of_run(directory).need("config.toml");
}

// Returns how the estimates of two sampled runs differ.
std::string samples_text(const report::RunRecord& was, const report::RunRecord& is, const std::string& before,
                         const std::string& after) {
  const auto batches_of = [](const std::string& directory) {
    return report::ListedFiles::of_run(directory).need("sample.csv");
  };
  return report::comparison_text(report::compare_samples(was, is, batches_of(before), batches_of(after)));
}

// Compares two runs. `name` is the workload's of a bench, or "".
Exit compare_runs(const std::string& name, const std::string& before, const std::string& after,
                  const std::vector<report::Condition>& conditions, bool all) {
  const report::RunRecord was = report::RunRecord::read(before), is = report::RunRecord::read(after);
  const std::vector<report::Change> changes = report::changes(was, is);
  tell_of_files({before, after});
  if (const std::string different = report::different_work(was, is); !different.empty())
    fmt::print(stderr,
               "warning: the runs did different work, so their numbers say little of each other: {}\n",
               different);
  const std::string title = name.empty() ? "" : fmt::format("== {}\n", name),
                    keys = report::changed_keys_text(config_of(before), config_of(after));
  const bool sampled = report::is_sampled(was) && report::is_sampled(is);
  write_output("", title +
                       (sampled ? samples_text(was, is, before, after) + keys
                                : report::changes_text(changes, all) + report::uncompared_text(was, is) +
                                      keys + report::changed_stalls_text(was, is, all)) +
                       (name.empty() ? "" : "\n"));
  Exit exit = Exit::Ok;
  for (const report::Condition& condition : conditions) {
    if (!report::holds(condition, changes)) continue;
    fmt::print(stderr, "failed: {}{}\n", name.empty() ? "" : name + ": ", condition.text);
    exit = Exit::Failure;
  }
  return exit;
}

// Compares the workloads that both folders of `glint bench` have.
Exit compare_benches(const CompareOptions& options, const std::vector<report::Condition>& conditions) {
  const auto before = finished_runs(options.before), after = finished_runs(options.after);
  const std::map<std::string, std::string> others(after.begin(), after.end());
  Exit exit = Exit::Ok;
  size_t compared = 0;
  for (const auto& [name, folder] : before)
    if (const auto other = others.find(name); other != others.end()) {
      ++compared;
      if (compare_runs(name, folder, other->second, conditions, options.all) != Exit::Ok)
        exit = Exit::Failure;
    }
  if (compared == 0)
    throw UserError({},
                    fmt::format("'{}' and '{}' have no workload in common", options.before, options.after));
  if (compared < before.size() || compared < after.size())
    fmt::print(stderr, "warning: {} of the {} and {} workloads are in both folders\n", compared,
               before.size(), after.size());
  return exit;
}

Exit compare(const CompareOptions& options) {
  std::vector<report::Condition> conditions;
  for (const std::string& text : options.fail_on) conditions.push_back(report::parse_condition(text));
  const auto is_bench = [](const std::string& folder) {
    std::error_code failed;
    return !std::filesystem::exists(folder + "/run.json", failed) &&
           std::filesystem::exists(folder + "/metrics.csv", failed);
  };
  if (is_bench(options.before) && is_bench(options.after)) return compare_benches(options, conditions);
  return compare_runs("", options.before, options.after, conditions, options.all);
}

}  // namespace

void add_compare(Command app, Session& session) {
  auto options = std::make_shared<CompareOptions>();
  Command command = app.add_subcommand(
      "compare",
      "Print what changed from one finished run to another, or between two folders of `glint bench`");
  command.add_option("A", options->before, "Directory of the run or bench before the change").required();
  command.add_option("B", options->after, "Directory of the run or bench after the change").required();
  command
      .add_option("--fail-on", options->fail_on,
                  "Exit with 1 when a metric changed by less or more than this, such as 'thread_ipc<-2%' or "
                  "'cycles>1%'; repeatable")
      .allow_extra_args(false);
  command.add_flag("--all", options->all, "Print metrics that did not change, too");
  command.callback([&session, options] { session.action = [options] { return compare(*options); }; });
}

}  // namespace glint::app
