// Keeps the metrics.csv of a bench folder, which several benches may fill.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <set>
#include <string>

namespace glint::app {

class MetricsTable {
 public:
  // Reads the rows that earlier benches left in the folder for workloads other than `planned`. Throws
  // UserError when a bench must not write there: the folder holds files but no metrics.csv of a bench, or its
  // rows have other columns and would be lost.
  MetricsTable(const std::string& folder, const std::set<std::string>& planned);

  bool is_new() const { return is_new_; }  // The folder has no metrics.csv yet.
  void set(const std::string& workload, const std::string& row) { rows_[workload] = row; }
  // Returns the file: all rows in the order of all_workloads(), and behind them those of unknown workloads.
  std::string text() const;

 private:
  bool is_new_ = true;
  std::map<std::string, std::string> rows_;  // line of each workload
};

}  // namespace glint::app
