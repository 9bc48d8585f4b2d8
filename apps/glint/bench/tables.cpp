// Finds tables and runs in a folder of `glint bench`.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench/tables.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "apps/glint/session.h"
#include "base/diagnostics.h"
#include "base/regular_file.h"
#include "report/files/csv_table.h"
#include "report/files/run_facts.h"
#include "setup/resources.h"

namespace glint::app {

namespace fs = std::filesystem;
constexpr int kBenchSchema = 1;  // schema of kBenchRecord

std::string metrics_file(const std::string& file_or_folder) {
  if (!fs::is_directory(file_or_folder)) return file_or_folder;
  const std::string path = (fs::path(file_or_folder) / "metrics.csv").string();
  if (!fs::exists(path))
    throw UserError({path}, "there is no such file", "`glint bench --out DIR` writes it into DIR");
  return path;
}

std::string bench_record(const report::FileList& written) {
  return nlohmann::ordered_json{{"schema", kBenchSchema}, {"files", report::json_of(written)}}.dump(2) + "\n";
}

std::string read_metrics(const std::string& path) {
  const fs::path table(path);
  const std::string folder = table.has_parent_path() ? table.parent_path().string() : ".",
                    record = folder + "/" + kBenchRecord;
  std::optional<report::FileList> list;
  if (const std::optional<std::string> text = read_regular_file(record)) {
    const nlohmann::ordered_json json = report::json_object(*text, record);
    if (json.contains("files")) list = report::file_list(json["files"], record);
  }
  const report::ListedFiles files(folder, kBenchRecord,
                                  "remove metrics.csv and run the bench again with --resume, which keeps the "
                                  "workloads that are complete",
                                  std::move(list));
  const std::optional<std::string> text = files.read(table.filename().string());
  return text ? *text
              : setup::read_file(path);  // read_file() says why it cannot be read, and reads pipes, too.
}

namespace {

std::set<std::string> workloads_of(const fs::path& metrics) {
  std::set<std::string> out;
  if (!fs::exists(metrics)) return out;
  for (const std::vector<std::string>& row :
       report::read_csv(read_metrics(metrics.string()), metrics.string()).rows)
    out.insert(row.at(0));
  return out;
}

}  // namespace

BenchContents bench_contents(const std::string& folder) {
  const std::set<std::string> members = workloads_of(fs::path(folder) / "metrics.csv");
  BenchContents out;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!fs::exists(entry.path() / "run.json")) continue;
    const std::string name = entry.path().filename().string();
    (members.empty() || members.contains(name) ? out.runs : out.others).push_back(entry.path().string());
  }
  std::ranges::sort(out.runs);
  std::ranges::sort(out.others);
  return out;
}

std::vector<std::string> bench_runs(const std::string& folder) {
  const BenchContents contents = bench_contents(folder);
  std::vector<std::string> others;
  for (const std::string& run : contents.others) others.push_back(fs::path(run).filename().string());
  if (!others.empty())
    fmt::print(stderr,
               "warning: {}: these runs are left out, because its metrics.csv does not have them (they "
               "failed, or no bench made them): {}\n",
               folder, fmt::join(others, " "));
  return contents.runs;
}

std::vector<std::pair<std::string, std::string>> finished_runs(const std::string& folder) {
  const auto is_run = [](const fs::path& path) {
    return fs::exists(path / "run.json") && fs::exists(path / "stats.csv");
  };
  const auto name_of = [](const fs::path& path) {
    return (path.has_filename() ? path : path.parent_path()).filename().string();
  };
  if (!fs::is_directory(folder))
    throw UserError({}, fmt::format("'{}' is not a folder", folder),
                    "`glint run --out DIR` and `glint bench --out DIR` make some");
  if (fs::exists(fs::path(folder) / "run.json")) return {{name_of(fs::absolute(folder)), folder}};
  std::vector<std::pair<std::string, std::string>> out;
  for (const std::string& run : bench_runs(folder))
    if (is_run(run)) out.emplace_back(name_of(run), run);
  if (out.empty())
    throw UserError({}, fmt::format("'{}' holds no finished run", folder),
                    "`glint run --out DIR` and `glint bench --out DIR` make some");
  return out;
}

}  // namespace glint::app
