// Declares the metrics of a workload in the LumiBench paper's terms: 35 of the GPU, 29 of the RT unit, and 23
// of scene and shaders.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/files/run_record.h"

namespace glint::report {

struct Metric {
  std::string_view name, unit, doc;
  std::string_view formula;  // formula (report/metrics/formula.h); "": Glint cannot give it
  std::string_view paper;    // figure or table that shows the metric, or why there is no formula
};

// Holds a group of columns, in the order of the file.
struct MetricGroup {
  std::string_view title;
  std::span<const Metric> metrics;
};
std::span<const MetricGroup> metric_groups();

// Holds one column: its value, or nothing.
struct MetricValue {
  const Metric* metric = nullptr;
  std::optional<double> value;
};
std::vector<MetricValue> metrics_of(const RunRecord& run);

// Return metrics.csv: what identifies the run, then every metric. What cannot be given is an empty cell.
std::string metrics_header();
std::string metrics_row(const std::string& workload, const RunRecord& run);

std::string metrics_text(const RunRecord& run);  // a line per metric, for a terminal
std::string metrics_markdown();                  // docs/metrics.md

}  // namespace glint::report
