// Tables and runs of a folder of `glint bench`.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/diagnostics.h"

namespace glint::app {

namespace fs = std::filesystem;

std::string metrics_file(const std::string& file_or_folder) {
  if (!fs::is_directory(file_or_folder)) return file_or_folder;
  const std::string path = (fs::path(file_or_folder) / "metrics.csv").string();
  if (!fs::exists(path)) throw UserError({path}, "there is no such file", "`glint bench --out DIR` writes it into DIR");
  return path;
}

std::vector<std::pair<std::string, std::string>> finished_runs(const std::string& folder) {
  const auto is_run = [](const fs::path& path) { return fs::exists(path / "run.json") && fs::exists(path / "stats.csv"); };
  const auto name_of = [](const fs::path& path) { return (path.has_filename() ? path : path.parent_path()).filename().string(); };
  if (!fs::is_directory(folder)) throw UserError({}, fmt::format("'{}' is no folder", folder), "`glint run --out DIR` and `glint bench --out DIR` make some");
  if (is_run(folder)) return {{name_of(fs::absolute(folder)), folder}};
  std::vector<std::pair<std::string, std::string>> out;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (is_run(entry.path())) out.emplace_back(name_of(entry.path()), entry.path().string());
  std::ranges::sort(out);
  if (out.empty()) throw UserError({}, fmt::format("'{}' holds no finished run", folder), "`glint run --out DIR` and `glint bench --out DIR` make some");
  return out;
}

}  // namespace glint::app
