// Writes matrices and lists of a characterisation.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/characterization_files.h"

#include <fmt/format.h>

#include "report/files/csv_field.h"

namespace glint::report {
namespace {

// Returns a table with one row per name and one column per heading.
std::string matrix(const std::string& corner, const std::vector<std::string>& names,
                   const std::vector<std::string>& columns, const Eigen::MatrixXd& values) {
  std::string out = corner;
  for (const std::string& column : columns) out += "," + csv_field(column);
  out += "\n";
  for (size_t i = 0; i < names.size(); ++i) {
    out += csv_field(names[i]);
    for (Eigen::Index j = 0; j < values.cols(); ++j) out += fmt::format(",{}", values(Eigen::Index(i), j));
    out += "\n";
  }
  return out;
}

std::vector<std::string> component_names(Eigen::Index count) {
  std::vector<std::string> out;
  for (Eigen::Index i = 1; i <= count; ++i) out.push_back(fmt::format("PC{}", i));
  return out;
}

std::string eigenvalues(const PrincipalComponents& pca) {
  std::string out = "component,eigenvalue,share,cumulative,kept\n";
  double sum = 0;
  for (Eigen::Index i = 0; i < pca.eigenvalues.size(); ++i) {
    sum += pca.eigenvalues[i];
    out += fmt::format("PC{},{},{},{},{}\n", i + 1, pca.eigenvalues[i],
                       pca.eigenvalues[i] / pca.eigenvalues.sum(), sum / pca.eigenvalues.sum(),
                       int(i < pca.kept));
  }
  return out;
}

std::string linkage(const std::vector<Join>& joins) {
  std::string out = "first,second,distance,leaves\n";
  for (const Join& join : joins)
    out += fmt::format("{},{},{},{}\n", join.first, join.second, join.distance, join.size);
  return out;
}

std::string leaves(const Characterization& result) {
  std::string out = "position,row,workload,cluster\n";
  for (size_t i = 0; i < result.leaves.size(); ++i) {
    const size_t row = size_t(result.leaves[i]);
    out += fmt::format("{},{},{},{}\n", i, row, csv_field(result.table.workloads[row]),
                       result.cluster_of[row] + 1);
  }
  return out;
}

std::string subset(const Characterization& result) {
  std::string out = "cluster,workload,distance_to_centre\n";
  for (const Representative& one : result.chosen)
    out += fmt::format("{},{},{}\n", one.cluster + 1, csv_field(result.table.workloads[size_t(one.row)]),
                       one.distance);
  return out;
}

std::string chosen_metrics(const Characterization& result) {
  std::string out = "metric,fitness,fitness_without\n";
  for (const ChosenMetrics::Metric& one : result.metrics.metrics)
    out += fmt::format("{},{},{}\n", csv_field(result.table.metrics[size_t(one.column)]),
                       result.metrics.fitness, one.fitness_without);
  return out;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> characterization_files(const Characterization& result) {
  const FeatureTable& table = result.table;
  const std::vector<std::string> components = component_names(result.components.kept);
  std::string dropped = "metric,why\n";
  for (const FeatureTable::Dropped& one : table.dropped)
    dropped += csv_field(one.column) + "," + csv_field(one.why) + "\n";
  std::vector<std::string> chosen;
  for (const ChosenMetrics::Metric& one : result.metrics.metrics)
    chosen.push_back(table.metrics[size_t(one.column)]);
  return {{"standardised.csv", matrix("workload", table.workloads, table.metrics, table.standardised)},
          {"dropped.csv", dropped},
          {"eigenvalues.csv", eigenvalues(result.components)},
          {"loadings.csv", matrix("metric", table.metrics, components, result.components.loadings)},
          {"scores.csv", matrix("workload", table.workloads, components, result.components.scores)},
          {"linkage.csv", linkage(result.joins)},
          {"leaves.csv", leaves(result)},
          {"subset.csv", subset(result)},
          {"metrics_chosen.csv", chosen_metrics(result)},
          {"kiviat.csv", matrix("workload", table.workloads, chosen, result.kiviat)}};
}

}  // namespace glint::report
