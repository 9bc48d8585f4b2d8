// Prints notes on the files of runs.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/run_files.h"

#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/files/file_list.h"
#include "report/files/run_record.h"

namespace glint::app {

void tell_of_files(const std::vector<std::string>& directories) {
  std::vector<std::string> without;
  for (const std::string& directory : directories) {
    const report::ListedFiles files = report::ListedFiles::of_run(directory);
    if (!files.has_list()) without.push_back(directory);
    report::RunRecord facts;
    facts.add_finished(directory);
    if (!facts.text("partial.reason").empty())
      fmt::print(stderr, "note: {} is partial: {}\n", directory, facts.text("message"));
    if (const std::vector<std::string> gone = files.gone(); !gone.empty())
      fmt::print(stderr, "note: {}: these files of the run are gone: {}\n", directory, fmt::join(gone, ", "));
  }
  if (!without.empty())
    fmt::print(stderr,
               "note: an earlier version of Glint wrote {}{}, without the lengths and sums of its files, so "
               "damage to them cannot be noticed\n",
               without[0], without.size() > 1 ? fmt::format(" and {} more runs", without.size() - 1) : "");
}

}  // namespace glint::app
