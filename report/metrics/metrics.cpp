// Writes metrics as a table's row, as lines and as a page.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/metrics.h"

#include <fmt/format.h>
#include <utility>

#include "report/files/csv_field.h"
#include "report/metrics/compare_samples.h"
#include "report/metrics/formula.h"
#include "report/terminal/table.h"

namespace glint::report {
namespace {

// These tell runs apart. Each has a column and its name in run.json.
constexpr std::pair<std::string_view, std::string_view> kIdentity[] = {{"scene", "scene.name"},
                                                                       {"form", "scene.form"},
                                                                       {"shader", "shader"},
                                                                       {"config", "config.name"},
                                                                       {"config_hash", "config.hash"}};
constexpr std::pair<std::string_view, std::string_view> kNumbers[] = {
    {"fraction", "scene.fraction"}, {"width", "width"}, {"height", "height"}, {"samples", "samples"}};

std::string cell(std::optional<double> value) {
  return value ? fmt::format("{}", *value) : "";
}

// Returns what a sampled run estimates of a metric.
std::optional<double> estimate_of(const RunRecord& run, std::string_view metric) {
  if (metric != "cycles") return std::nullopt;
  const std::vector<double> values = run.values("gpu.sample.cycles");
  return values.empty() ? std::nullopt : std::optional(values[0]);
}

}  // namespace

std::vector<MetricValue> metrics_of(const RunRecord& run) {
  std::vector<MetricValue> out;
  // The counts of a sampled run are those of a part of the launch, so only its estimate has a metric.
  const bool sampled = is_sampled(run);
  for (const MetricGroup& group : metric_groups())
    for (const Metric& metric : group.metrics)
      out.push_back({&metric, sampled                  ? estimate_of(run, metric.name)
                              : metric.formula.empty() ? std::nullopt
                                                       : evaluate(std::string(metric.formula), run)});
  return out;
}

std::string metrics_header() {
  std::string out = "workload";
  for (const auto& [column, name] : kIdentity) out += fmt::format(",{}", column);
  for (const auto& [column, name] : kNumbers) out += fmt::format(",{}", column);
  for (const MetricGroup& group : metric_groups())
    for (const Metric& metric : group.metrics) out += fmt::format(",{}", metric.name);
  return out + "\n";
}

std::string metrics_row(const std::string& workload, const RunRecord& run) {
  std::string out = csv_field(workload);
  for (const auto& [column, name] : kIdentity) out += "," + csv_field(run.text(std::string(name)));
  for (const auto& [column, name] : kNumbers) out += "," + cell(run.fact(std::string(name)));
  for (const MetricValue& value : metrics_of(run)) out += "," + cell(value.value);
  return out + "\n";
}

std::string metrics_text(const RunRecord& run) {
  std::vector<std::vector<std::string>> rows;
  for (const MetricValue& value : metrics_of(run)) {
    const Metric& metric = *value.metric;
    const std::string why = metric.formula.empty() ? std::string(metric.paper) : why_absent(run);
    rows.push_back({std::string(metric.name), value.value ? fmt::format("{:.6g}", *value.value) : "-",
                    std::string(metric.unit), value.value ? std::string(metric.doc) : why});
  }
  return table(rows, "<><<");
}

std::string metrics_markdown() {
  std::string out;
  for (const MetricGroup& group : metric_groups()) {
    out += fmt::format(
        "## {} ({})\n\n| metric | unit | meaning | formula | in the paper |\n|---|---|---|---|---|\n",
        group.title, group.metrics.size());
    for (const Metric& m : group.metrics) {
      const bool absent = m.formula.empty();
      out += fmt::format("| `{}` | {} | {} | {} | {} |\n", m.name, m.unit, m.doc,
                         absent ? fmt::format("*empty:* {}", m.paper) : fmt::format("`{}`", m.formula),
                         absent ? "" : m.paper);
    }
    out += "\n";
  }
  out.pop_back();
  return out;
}

}  // namespace glint::report
