// Writes a characterisation as one document.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/characterization_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "report/metrics/metrics.h"
#include "report/page/suite.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

std::vector<double> row_of(const Eigen::MatrixXd& values, size_t row) {
  std::vector<double> out;
  for (Eigen::Index j = 0; j < values.cols(); ++j) out.push_back(values(Eigen::Index(row), j));
  return out;
}

// Returns the metric, with unit and meaning, when Glint knows it.
const Metric* known_metric(const std::string& name) {
  for (const MetricGroup& group : metric_groups())
    for (const Metric& metric : group.metrics)
      if (metric.name == name) return &metric;
  return nullptr;
}

Json workloads_json(const Characterization& result) {
  const FeatureTable& table = result.table;
  const auto has = [](const std::vector<int>& rows, size_t row) {
    return std::ranges::find(rows, int(row)) != rows.end();
  };
  const auto cycles = std::ranges::find(table.metrics, "cycles") - table.metrics.begin();
  Json out = Json::array();
  for (size_t i = 0; i < table.workloads.size(); ++i)
    out.push_back(
        {{"name", table.workloads[i]},
         {"shader", table.shaders[i]},
         {"cycles", cycles < table.columns() ? Json(table.values(Eigen::Index(i), cycles)) : Json()},
         {"cluster", result.cluster_of[i]},
         {"chosen", has(result.subset.rows, i)},
         {"reference", has(result.reference.rows, i)},
         {"scores", row_of(result.components.scores, i)},
         {"kiviat", row_of(result.kiviat, i)}});
  return out;
}

Json axes_json(const Characterization& result) {
  Json out = Json::array();
  for (const ChosenMetrics::Metric& one : result.metrics.metrics) {
    const auto values = result.table.values.col(one.column);
    const std::string& name = result.table.metrics[size_t(one.column)];
    const Metric* metric = known_metric(name);
    out.push_back({{"name", name},
                   {"unit", metric ? metric->unit : ""},
                   {"doc", metric ? metric->doc : ""},
                   {"least", values.minCoeff()},
                   {"most", values.maxCoeff()},
                   {"fitness_without", one.fitness_without}});
  }
  return out;
}

Json loadings_json(const Characterization& result) {
  Json out = Json::array();
  for (size_t j = 0; j < result.table.metrics.size(); ++j)
    out.push_back({{"metric", result.table.metrics[j]}, {"values", row_of(result.components.loadings, j)}});
  return out;
}

}  // namespace

Json characterization_json(const Characterization& result, const CharacterizationSource& source) {
  Json joins = Json::array(), dropped = Json::array(), representatives = Json::array();
  for (const Join& join : result.joins) joins.push_back({join.first, join.second, join.distance, join.size});
  for (const FeatureTable::Dropped& one : result.table.dropped)
    dropped.push_back({{"column", one.column}, {"why", one.why}});
  for (const Representative& one : result.chosen)
    representatives.push_back({{"cluster", one.cluster}, {"row", one.row}, {"distance", one.distance}});
  const Eigen::VectorXd& values = result.components.eigenvalues;
  return {{"kind", kCharacterizationKind},
          {"schema", kCharacterizationSchema},
          {"version", source.version},
          {"source", source.name},
          {"workloads", workloads_json(result)},
          {"dropped", std::move(dropped)},
          {"eigenvalues", std::vector<double>(values.begin(), values.end())},
          {"kept", result.components.kept},
          {"explained", result.components.explained()},
          {"loadings", loadings_json(result)},
          {"linkage", name_of(result.options.linkage)},
          {"joins", std::move(joins)},
          {"leaves", result.leaves},
          {"clusters", result.options.clusters},
          {"cut", {result.cut_low, result.cut_high}},
          {"cophenetic", result.cophenetic},
          {"representatives", std::move(representatives)},
          {"coverage_error", result.subset.coverage_error},
          {"reference",
           {{"name", result.options.reference_name},
            {"known", !result.reference.rows.empty()},
            {"coverage_error", result.reference.coverage_error},
            {"clusters_met", result.reference.clusters_met}}},
          {"axes", axes_json(result)},
          {"fitness", result.metrics.fitness}};
}

}  // namespace glint::report
