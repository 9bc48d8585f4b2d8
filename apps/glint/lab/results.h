// Compares the arms of an experiment, workload by workload, and sets them beside what was published.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/glint/lab/experiment.h"

namespace glint::app {

struct LabRow {
  std::string workload;
  double cycles = 0;
  std::optional<double> speedup;               // against the baseline; none for a baseline
  std::vector<std::optional<double>> figures;  // in the order of the arm's figures
};

struct LabResult {
  const LabArm* arm = nullptr;
  std::vector<LabRow> rows;
  std::optional<double> geomean;               // of the speed-ups
  std::vector<std::optional<double>> figures;  // geometric means of ratios, means of other numbers

  // Returns whether everything that the experiment expects of the arm holds; nothing where it expects
  // nothing.
  std::optional<bool> holds() const;
  // Returns whether the effect has the published sign: both speed-ups lie on the same side of 1. Nothing
  // where none was published.
  std::optional<bool> has_published_sign() const;
};

// Reads the finished runs of all arms. `folder` has a folder of each arm, as a bench leaves it. Throws
// UserError when a run of an arm is absent from its baseline.
std::vector<LabResult> lab_results(const Experiment& experiment, const std::string& folder);

// Return the results as a table for a terminal, and as CSV with one line for each arm and workload.
std::string lab_table(const Experiment& experiment, const std::vector<LabResult>& results);
std::string lab_csv(const std::vector<LabResult>& results);
// Returns them as the document lab.json, which `glint report` draws (report/page/lab.h). Its list "refused"
// is empty.
nlohmann::ordered_json lab_json(const Experiment& experiment, const std::vector<LabResult>& results);

}  // namespace glint::app
