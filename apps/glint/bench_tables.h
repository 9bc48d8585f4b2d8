// Finding what `glint bench` has left in a folder.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace glint::app {

// metrics.csv of a folder; a file's name as it is. UserError where the folder has none.
std::string metrics_file(const std::string& file_or_folder);

// Workload and directory of every finished run below a folder, by name; the folder itself where it is a run. UserError where
// there is none.
std::vector<std::pair<std::string, std::string>> finished_runs(const std::string& folder);

}  // namespace glint::app
