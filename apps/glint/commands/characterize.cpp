// Declares `glint characterize METRICS`, which says which workloads are alike, which of them stand for all,
// and which metrics tell them apart.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/glint/bench/tables.h"
#include "apps/glint/bench/workloads.h"
#include "apps/glint/options/command_line.h"
#include "apps/glint/options/output.h"
#include "apps/glint/session.h"
#include "report/characterize/characterization.h"
#include "report/characterize/characterization_files.h"
#include "report/characterize/characterization_json.h"
#include "report/files/file_list.h"
#include "report/files/folder_lock.h"
#include "report/files/run_directory.h"

namespace glint::app {
namespace {

constexpr const char* kDocument = "characterization.json";

struct CharacterizeOptions {
  std::string input, out, linkage = "average";
  std::vector<std::string> against;
  int clusters = 8;
  report::SearchSettings search;
};

std::string range_text(const report::SpeedUps::Range& range) {
  return fmt::format("mean {:.3f}, from {:.3f} ({}) to {:.3f} ({})", range.mean, range.least, range.slowest,
                     range.most, range.fastest);
}

// Prints how well a subset tells the speed-up of all workloads on another configuration.
void print_speed_ups(const std::string& csv, const std::string& metrics, const std::string& other,
                     const report::Characterization& result) {
  const std::string path = metrics_file(other), after = read_metrics(path);
  const auto names = [&](const std::vector<int>& rows) {
    std::vector<std::string> out;
    for (const int row : rows) out.push_back(result.table.workloads[size_t(row)]);
    return out;
  };
  const report::SpeedUps ours = report::speed_ups(csv, metrics, after, path, names(result.subset.rows));
  print_output(
      "\nSpeed-up from {} to {} (geometric means)\n  all workloads:    {}\n  representatives:  {}; mean "
      "{:+.1f} %\n",
      metrics, path, range_text(ours.all), range_text(ours.subset), 100 * ours.error());
  if (result.reference.rows.empty()) return;
  const report::SpeedUps theirs = report::speed_ups(csv, metrics, after, path, names(result.reference.rows));
  print_output("  {}: {}; mean {:+.1f} %\n", result.options.reference_name, range_text(theirs.subset),
               100 * theirs.error());
}

Exit characterize(const CharacterizeOptions& options) {
  const std::string metrics = metrics_file(options.input), csv = read_metrics(metrics);
  report::CharacterizationOptions how{.linkage = report::linkage_of(options.linkage),
                                      .clusters = options.clusters,
                                      .search = options.search,
                                      .reference = {},
                                      .reference_name = "the paper's subset"};
  for (const NamedWorkload& workload : lumibench())
    if (workload.in_subset) how.reference.push_back(workload.name());
  const report::Characterization result = report::characterize(report::feature_table(csv, metrics), how);
  namespace fs = std::filesystem;
  const bool default_place = options.out.empty();
  const std::string out =
      default_place ? (fs::path(metrics).parent_path() / "characterization").string() : options.out;
  const report::RunDirectory directory(out);
  if (!report::is_unused_folder(out) && !fs::exists(directory.path_of(kDocument)))
    throw UserError({out}, "the folder holds files that are not of a characterisation",
                    "give --out a new or empty folder, or that of an earlier characterisation");
  const auto files = report::characterization_files(result);
  report::FileList list;
  for (const auto& [name, content] : files) list[name] = report::sum_of(content);
  nlohmann::ordered_json document =
      report::characterization_json(result, {.name = options.input, .version = GLINT_VERSION});
  document["files"] = report::json_of(list);
  // The document comes first, because it marks the folder.
  directory.write(kDocument, document.dump() + "\n");
  for (const auto& [name, content] : files) directory.write(name, content);
  write_output("", report::characterization_text(result));
  for (const std::string& other : options.against) print_speed_ups(csv, metrics, other, result);
  print_output("\n{}\n`glint report {}` draws it\n", directory.path_of(kDocument),
               default_place && fs::is_directory(options.input) ? options.input : out);
  return Exit::Ok;
}

}  // namespace

void add_characterize(Command app, Session& session) {
  auto options = std::make_shared<CharacterizeOptions>();
  Command command = app.add_subcommand("characterize",
                                       "Compare workloads: find components, clusters, a subset that stands "
                                       "for all, and the metrics that tell them apart");
  command
      .add_option("METRICS", options->input,
                  "Table to read: metrics.csv of `glint bench`, the folder that has it, or a table whose "
                  "first column names workloads")
      .required();
  command
      .add_option("-o,--out", options->out,
                  "Folder to write tables and characterization.json to (default: characterization beside "
                  "metrics.csv)")
      .type_name("DIR");
  command.add_option("--linkage", options->linkage, "Selects how the distance between groups is measured")
      .one_of({"single", "complete", "average", "ward"})
      .capture_default_str();
  command
      .add_option("--clusters", options->clusters,
                  "Number of clusters, which is also the number of workloads of the subset")
      .in_range(1, 1000)
      .capture_default_str();
  command.add_option("--metrics", options->search.count, "Number of metrics to choose")
      .in_range(1, 1000)
      .capture_default_str();
  command.add_option("--seed", options->search.seed, "Seed of the search for metrics").capture_default_str();
  command
      .add_option("--against", options->against,
                  "metrics.csv or folder of the same workloads on another configuration, to check that the "
                  "subset tells the speed-up; repeatable")
      .allow_extra_args(false);
  command.callback([&session, options] { session.action = [options] { return characterize(*options); }; });
}

}  // namespace glint::app
