// Finds what `glint bench` has left in a folder.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "report/files/file_list.h"

namespace glint::app {

// Returns the path of a folder's metrics.csv; the name of a file is returned unchanged. Throws UserError when
// the folder has no metrics.csv.
std::string metrics_file(const std::string& file_or_folder);

// This file of a bench folder lists the tables beside it, as run.json lists the files of a run.
inline constexpr const char* kBenchRecord = "bench.json";
std::string bench_record(const report::FileList& written);  // the text of that file

// Returns the text of a table. Throws UserError when the file cannot be read, or a kBenchRecord beside it
// says that the bench has written something else.
std::string read_metrics(const std::string& path);

// Holds directories of runs in a folder of `glint bench`, ordered by name. `others` are those that its
// metrics.csv does not have: failed ones, or those of `glint run`.
struct BenchContents {
  std::vector<std::string> runs, others;
};
BenchContents bench_contents(const std::string& folder);

// Returns the directories of the runs in a folder of `glint bench`, ordered by name. These are the runs of
// its metrics.csv, which benches completed. Other runs in the folder (failed ones, or those of `glint run`)
// are named on stderr. When metrics.csv has no rows or does not exist, all runs are returned.
std::vector<std::string> bench_runs(const std::string& folder);

// Returns workload and directory of every finished run below a folder, as bench_runs() finds them, or the
// folder itself when it is a run. Throws UserError when there is none.
std::vector<std::pair<std::string, std::string>> finished_runs(const std::string& folder);

}  // namespace glint::app
