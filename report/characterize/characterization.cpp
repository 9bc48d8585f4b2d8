// Runs the steps of the analysis, and writes their summary for a terminal.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/characterization.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <utility>

#include "report/terminal/table.h"

namespace glint::report {
namespace {

Subset judged(const Characterization& result, std::vector<int> rows) {
  Subset out;
  std::set<int> met;
  for (const int row : rows) met.insert(result.cluster_of[size_t(row)]);
  out.coverage_error = coverage_error(result.components.scores, rows);
  out.clusters_met = int(met.size());
  out.rows = std::move(rows);
  return out;
}

// Returns the rows of the named workloads that the table has, in the order of the names.
std::vector<int> rows_of(const FeatureTable& table, const std::vector<std::string>& names) {
  std::vector<int> out;
  for (const std::string& name : names)
    if (const auto found = std::ranges::find(table.workloads, name); found != table.workloads.end())
      out.push_back(int(found - table.workloads.begin()));
  return out;
}

void cluster(Characterization& result) {
  const int n = int(result.table.rows());
  result.options.clusters = std::clamp(result.options.clusters, 1, n);
  result.joins = hierarchy(result.components.scores, result.options.linkage);
  result.leaves = leaf_order(result.joins);
  result.cluster_of = clusters(result.joins, result.options.clusters);
  result.cophenetic = cophenetic_correlation(result.joins, result.components.scores);
  const int kept = n - result.options.clusters;
  result.cut_low = kept > 0 ? result.joins[size_t(kept) - 1].distance : 0;
  result.cut_high = kept < int(result.joins.size()) ? result.joins[size_t(kept)].distance : result.cut_low;
}

void draw_kiviat(Characterization& result) {
  result.kiviat.resize(result.table.rows(), Eigen::Index(result.metrics.metrics.size()));
  for (Eigen::Index j = 0; j < result.kiviat.cols(); ++j) {
    const Eigen::ArrayXd values = result.table.values.col(result.metrics.metrics[size_t(j)].column).array();
    result.kiviat.col(j) =
        (values - values.minCoeff()) / (values.maxCoeff() - values.minCoeff());  // No column is constant.
  }
}

std::string names_of(const FeatureTable& table, const std::vector<int>& rows) {
  std::string out;
  for (const int row : rows) out += (out.empty() ? "" : ", ") + table.workloads[size_t(row)];
  return out;
}

std::string components_text(const Characterization& result) {
  const PrincipalComponents& pca = result.components;
  const std::string kept = pca.eigenvalues[0] > 1
                               ? fmt::format("{} with an eigenvalue above 1 have", pca.kept)
                               : "none has an eigenvalue above 1; the first has";
  std::string out = fmt::format("\nComponents: {} {} of the variance\n", kept, percent(pca.explained()));
  double sum = 0;
  std::vector<std::vector<std::string>> rows = {{"", "eigenvalue", "together", "loads most on"}};
  for (Eigen::Index i = 0; i < pca.kept; ++i) {
    std::vector<int> order(result.table.metrics.size());
    for (size_t j = 0; j < order.size(); ++j) order[j] = int(j);
    std::ranges::stable_sort(order, std::ranges::greater{},
                             [&](int j) { return std::abs(pca.loadings(j, i)); });
    std::string most;
    for (size_t k = 0; k < std::min<size_t>(4, order.size()); ++k)
      most += fmt::format("{}{} {:+.2f}", k ? ", " : "", result.table.metrics[size_t(order[k])],
                          pca.loadings(order[k], i));
    sum += pca.eigenvalues[i];
    rows.push_back({fmt::format("PC{}", i + 1), fmt::format("{:.2f}", pca.eigenvalues[i]),
                    percent(sum / pca.eigenvalues.sum()), most});
  }
  return out + table(rows, "<>><", " ");
}

std::string clusters_text(const Characterization& result) {
  std::string out = fmt::format(
      "\nClusters: {} linkage on Euclidean distance, cut into {}; tree and distances correlate by {:.3f}\n",
      name_of(result.options.linkage), result.options.clusters, result.cophenetic);
  std::vector<std::vector<std::string>> rows = {{"", "representative", "to centre", "of"}};
  for (const Representative& one : result.chosen) {
    std::vector<int> members;
    for (const int row : result.leaves)
      if (result.cluster_of[size_t(row)] == one.cluster) members.push_back(row);
    rows.push_back({fmt::format("{}", one.cluster + 1), result.table.workloads[size_t(one.row)],
                    fmt::format("{:.2f}", one.distance), names_of(result.table, members)});
  }
  out += table(rows, "><><", " ");
  out += fmt::format(
      "\nThe representatives are nearest to all workloads within {} of the mean distance between two.\n",
      percent(result.subset.coverage_error));
  if (!result.reference.rows.empty())
    out += fmt::format("{}: {}; in {} of {} clusters, within {}.\n", result.options.reference_name,
                       names_of(result.table, result.reference.rows), result.reference.clusters_met,
                       result.options.clusters, percent(result.reference.coverage_error));
  return out;
}

std::string metrics_text_of(const Characterization& result) {
  const ChosenMetrics& found = result.metrics;
  std::string out = fmt::format(
      "\nMetrics: distances in these {} correlate by {:.4f} with those in all {} ({} sets tried in {} "
      "generations, seed {})\n",
      found.metrics.size(), found.fitness, result.table.columns(), found.evaluations, found.generations,
      result.options.search.seed);
  std::vector<std::vector<std::string>> rows;
  for (const ChosenMetrics::Metric& metric : found.metrics)
    rows.push_back({result.table.metrics[size_t(metric.column)],
                    fmt::format("{:.4f} without it", metric.fitness_without)});
  return out + table(rows, "<>", " ");
}

}  // namespace

Characterization characterize(FeatureTable table, const CharacterizationOptions& options) {
  Characterization result;
  result.options = options;
  result.table = std::move(table);
  result.components = principal_components(result.table.standardised);
  cluster(result);
  result.chosen = representatives(result.table, result.components.scores, result.cluster_of);
  std::vector<int> rows;
  for (const Representative& one : result.chosen) rows.push_back(one.row);
  result.subset = judged(result, std::move(rows));
  if (std::vector<int> reference = rows_of(result.table, options.reference); !reference.empty())
    result.reference = judged(result, std::move(reference));
  result.metrics = choose_metrics(DistanceFitness(result.table.standardised), options.search);
  draw_kiviat(result);
  return result;
}

std::string characterization_text(const Characterization& result) {
  std::string out = fmt::format("{} workloads, {} metrics", result.table.rows(), result.table.columns());
  if (!result.table.dropped.empty())
    out += fmt::format("; {} columns left out:", result.table.dropped.size());
  out += "\n";
  std::vector<std::vector<std::string>> rows;
  for (const FeatureTable::Dropped& dropped : result.table.dropped)
    rows.push_back({dropped.column, dropped.why});
  return out + report::table(rows, "<<", " ") + components_text(result) + clusters_text(result) +
         metrics_text_of(result);
}

}  // namespace glint::report
