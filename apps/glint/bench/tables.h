// Finding what `glint bench` has left in a folder.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace glint::app {

// metrics.csv of a folder; a file's name as it is. UserError where the folder has none.
std::string metrics_file(const std::string& file_or_folder);

// Directories of the runs of a folder of `glint bench`, by name: those of its metrics.csv, so of the last
// bench and complete. Others that are there (of an earlier bench, or failed) are named on stderr. Without
// rows in metrics.csv, or without the file: all.
std::vector<std::string> bench_runs(const std::string& folder);

// Workload and directory of every finished run below a folder, as bench_runs(); the folder itself where it is
// a run. UserError where there is none.
std::vector<std::pair<std::string, std::string>> finished_runs(const std::string& folder);

}  // namespace glint::app
