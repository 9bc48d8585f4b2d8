// Merges the rows of several benches.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench/metrics_table.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

#include "apps/glint/bench/tables.h"
#include "apps/glint/bench/workloads.h"
#include "base/diagnostics.h"
#include "base/regular_file.h"
#include "report/files/csv_field.h"
#include "report/files/csv_table.h"
#include "report/files/folder_lock.h"
#include "report/files/run_facts.h"
#include "report/metrics/metrics.h"

namespace glint::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAdvice = "give --out a new or empty folder, or that of an earlier bench";

// A folder of folders is accepted, because a bench only adds to it. The bench itself may hold its lock there.
bool holds_only_folders(const std::string& folder) {
  const fs::directory_iterator entries(folder);
  return std::all_of(begin(entries), end(entries), [](const fs::directory_entry& entry) {
    return entry.is_directory() || entry.path().filename() == report::kLockFile;
  });
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string out;
  for (size_t i = 0; i < cells.size(); ++i) out += (i > 0 ? "," : "") + report::csv_field(cells[i]);
  return out + "\n";
}

}  // namespace

MetricsTable::MetricsTable(const std::string& folder, const std::set<std::string>& planned) {
  const std::string path = folder + "/metrics.csv";
  std::error_code error;
  if (!fs::exists(fs::symlink_status(path, error))) {
    if (fs::exists(folder + "/" + kBenchRecord, error)) return;
    if (fs::is_directory(folder, error) && !report::is_unused_folder(folder) && !holds_only_folders(folder))
      throw UserError({folder}, "the folder holds files that are not of a bench", kAdvice);
    return;
  }
  const std::optional<std::string> text = read_regular_file(path);
  if (!text || !text->starts_with("workload,")) throw UserError({path}, "no bench wrote this file", kAdvice);
  is_new_ = false;
  const report::CsvTable table = report::read_csv(read_metrics(path), path);
  for (const std::vector<std::string>& cells : table.rows)
    if (!planned.contains(cells[0])) rows_[cells[0]] = line_of(cells);
  if (!rows_.empty() && line_of(table.columns) != report::metrics_header())
    throw UserError(
        {path},
        fmt::format("its columns are those of another version of Glint, and its row of {} would be "
                    "lost",
                    rows_.begin()->first),
        kAdvice);
}

std::string MetricsTable::text() const {
  std::string out = report::metrics_header();
  std::map<std::string, std::string> others = rows_;
  for (const NamedWorkload& workload : all_workloads())
    if (const auto found = others.extract(workload.name())) out += found.mapped();
  for (const auto& [name, row] : others) out += row;
  return out;
}

}  // namespace glint::app
