// Compares two runs: what changed, and conditions on changes that scripts stop at.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "report/files/run_record.h"
#include "report/metrics/metrics.h"
#include "report/terminal/table.h"

namespace glint::report {

struct Change {
  const Metric* metric = nullptr;
  double before = 0, after = 0;
  std::optional<double> relative;  // (after - before) / before; absent when `before` is 0 and `after` is not
};

// Returns the metrics that both runs have, the largest change first. Metrics that were 0 and no longer are
// come before all others. The speed of the host (sim_rate) is left out.
std::vector<Change> changes(const RunRecord& before, const RunRecord& after);

// Names the metrics that only one of the runs has, A or B. Returns "" when both have the same.
std::string uncompared_text(const RunRecord& before, const RunRecord& after);

// Says in which facts of run.json the runs differ that make their numbers those of different work: what was
// launched, how large, with which seed, on which machine. Returns "" when there is none.
std::string different_work(const RunRecord& before, const RunRecord& after);

// Holds a condition such as "METRIC<-2%" or "METRIC>5%". It is met when the metric changed by less or more
// than this percentage of its value before.
struct Condition {
  std::string text, metric;
  bool below = false;
  double percent = 0;
};
// Reads a condition. Throws UserError when the text is not a condition or names no metric.
Condition parse_condition(const std::string& text);
// Returns whether a condition holds. Throws UserError when one of the runs has no such number.
bool holds(const Condition& condition, const std::vector<Change>& changes);

// Returns a line for each change; without `all`, only for metrics that changed.
std::string changes_text(const std::vector<Change>& changes, bool all);

}  // namespace glint::report
