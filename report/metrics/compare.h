// Two runs against each other: what changed, and conditions on changes that scripts stop at.
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
  std::optional<double> relative;  // (after - before) / before; absent where `before` is 0 and `after` is not
};

// Metrics that both runs have, the largest change first; what was 0 and is not any more comes before all. The
// speed of the host (sim_rate) is left out.
std::vector<Change> changes(const RunRecord& before, const RunRecord& after);

// Names the metrics that only one of the runs has, A or B; "" when both have the same.
std::string uncompared_text(const RunRecord& before, const RunRecord& after);

// "METRIC<-2%" or "METRIC>5%": holds when the metric changed by less or more than so many percent of what it
// was.
struct Condition {
  std::string text, metric;
  bool below = false;
  double percent = 0;
};
// UserError when the text is no condition or names no metric.
Condition parse_condition(const std::string& text);
// UserError when one of the runs has no such number.
bool holds(const Condition& condition, const std::vector<Change>& changes);

// A line a change; without `all` only metrics that changed.
std::string changes_text(const std::vector<Change>& changes, bool all);

}  // namespace glint::report
