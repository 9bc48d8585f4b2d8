// Writing the page of a characterisation.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/characterization_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/metrics.h"
#include "report/page_parts.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

std::vector<double> row_of(const Eigen::MatrixXd& values, size_t row) {
  std::vector<double> out;
  for (Eigen::Index j = 0; j < values.cols(); ++j) out.push_back(values(Eigen::Index(row), j));
  return out;
}

// Unit and meaning of a metric that Glint knows; of a stranger's nothing.
const Metric* known_metric(const std::string& name) {
  for (const MetricGroup& group : metric_groups())
    for (const Metric& metric : group.metrics)
      if (metric.name == name) return &metric;
  return nullptr;
}

Json workloads_json(const Characterization& result) {
  Json out = Json::array();
  const auto has = [](const std::vector<int>& rows, size_t row) { return std::ranges::find(rows, int(row)) != rows.end(); };
  for (size_t i = 0; i < result.table.workloads.size(); ++i)
    out.push_back({{"name", result.table.workloads[i]}, {"shader", result.table.shaders[i]}, {"cluster", result.cluster_of[i]}, {"chosen", has(result.subset.rows, i)}, {"reference", has(result.reference.rows, i)},
                   {"scores", row_of(result.components.scores, i)}, {"kiviat", row_of(result.kiviat, i)}});
  return out;
}

Json axes_json(const Characterization& result) {
  Json out = Json::array();
  for (const ChosenMetrics::Metric& one : result.metrics.metrics) {
    const auto values = result.table.values.col(one.column);
    const std::string& name = result.table.metrics[size_t(one.column)];
    const Metric* metric = known_metric(name);
    out.push_back({{"name", name}, {"unit", metric ? metric->unit : ""}, {"least", values.minCoeff()}, {"most", values.maxCoeff()}});
  }
  return out;
}

std::string table_html(const std::string& head, const std::string& rows) {
  return "<div class=\"scroll\"><table class=\"metrics\"><thead><tr>" + head + "</tr></thead><tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string th(std::string_view text, bool is_number = false) { return fmt::format("<th scope=\"col\"{}>{}</th>", is_number ? " class=\"n\"" : "", text); }

std::string subset_table(const Characterization& result) {
  std::string rows;
  for (const Representative& one : result.chosen) {
    std::string members;
    for (const int row : result.leaves)
      if (result.cluster_of[size_t(row)] == one.cluster) members += (members.empty() ? "" : ", ") + escaped(result.table.workloads[size_t(row)]);
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"n\">{:.2f}</td><td class=\"doc\">{}</td></tr>\n", one.cluster + 1, escaped(result.table.workloads[size_t(one.row)]), one.distance, members);
  }
  std::string out = "<h3>Representative subset</h3>\n" + table_html(th("Cluster") + th("Workload") + th("To centre", true) + th("Members"), rows);
  if (!result.reference.rows.empty())
    out += fmt::format("<p class=\"note\">Compared with {}, which has workloads of {} of the {} clusters: mean distance to the nearest of the subset, of the mean distance between two workloads, is {:.1f} % with it, {:.1f} % with the subset above.</p>\n",
                       escaped(result.options.reference_name), result.reference.clusters_met, result.options.clusters, 100 * result.reference.coverage_error, 100 * result.subset.coverage_error);
  return out;
}

std::string chosen_table(const Characterization& result) {
  std::string rows;
  int number = 0;
  for (const ChosenMetrics::Metric& one : result.metrics.metrics) {
    const std::string& name = result.table.metrics[size_t(one.column)];
    const Metric* metric = known_metric(name);
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td><code>{}</code></td><td class=\"n\">{:.4f}</td><td class=\"u\">{}</td><td class=\"doc\">{}</td></tr>\n", ++number, escaped(name), one.fitness_without,
                        escaped(metric ? metric->unit : ""), escaped(metric ? metric->doc : ""));
  }
  return fmt::format("<h3>Representative metrics</h3>\n<p class=\"note\">Distances in these {} correlate by {:.4f} with those in all {}.</p>\n", result.metrics.metrics.size(), result.metrics.fitness, result.table.columns()) +
         table_html(th("") + th("Metric") + th("Correlation without it", true) + th("Unit") + th("Meaning"), rows);
}

std::string loadings_table(const Characterization& result) {
  const PrincipalComponents& pca = result.components;
  std::string head = th("Metric"), rows;
  for (Eigen::Index i = 0; i < pca.kept; ++i) head += th(fmt::format("PC{}", i + 1), true);
  for (size_t j = 0; j < result.table.metrics.size(); ++j) {
    rows += fmt::format("<tr><th scope=\"row\"><code>{}</code></th>", escaped(result.table.metrics[j]));
    for (const double value : row_of(pca.loadings, j)) rows += fmt::format("<td class=\"n{}\">{:.2f}</td>", std::abs(value) >= 0.7 ? " changed" : "", value);
    rows += "</tr>\n";
  }
  return "<h3>Loadings</h3>\n<p class=\"note\">Correlation of each metric with each component; those from 0.7 on are marked.</p>\n" + table_html(head, rows);
}

std::string dropped_table(const Characterization& result) {
  if (result.table.dropped.empty()) return "";
  std::string rows;
  for (const FeatureTable::Dropped& one : result.table.dropped) rows += fmt::format("<tr><th scope=\"row\"><code>{}</code></th><td class=\"doc\">{}</td></tr>\n", escaped(one.column), escaped(one.why));
  return "<h3>Columns left out</h3>\n" + table_html(th("Column") + th("Why"), rows);
}

}  // namespace

Json characterization_data(const Characterization& result, const CharacterizationSource& source, const Json& models) {
  Json joins = Json::array();
  for (const Join& join : result.joins) joins.push_back({join.first, join.second, join.distance, join.size});
  const Eigen::VectorXd& values = result.components.eigenvalues;
  return {{"kind", "characterization"}, {"schema", 1}, {"version", source.version}, {"source", source.name},
          {"workloads", workloads_json(result)}, {"num_metrics", result.table.columns()}, {"num_dropped", result.table.dropped.size()},
          {"eigenvalues", std::vector<double>(values.begin(), values.end())}, {"kept", result.components.kept}, {"explained", result.components.explained()},
          {"linkage", name_of(result.options.linkage)}, {"joins", std::move(joins)}, {"leaves", result.leaves}, {"clusters", result.options.clusters},
          {"cut", {result.cut_low, result.cut_high}}, {"cophenetic", result.cophenetic}, {"coverage_error", result.subset.coverage_error},
          {"reference", {{"name", result.options.reference_name}, {"known", !result.reference.rows.empty()}, {"coverage_error", result.reference.coverage_error}, {"clusters_met", result.reference.clusters_met}}},
          {"axes", axes_json(result)}, {"fitness", result.metrics.fitness}, {"models", models}};
}

std::string characterization_page(const Characterization& result, const Json& data, const PageParts& parts) {
  const std::string title = fmt::format("{} workloads", result.table.rows());
  std::string out = parts.frame;
  place(out, "<!--title-->", escaped(title) + " – Glint characterisation");
  place(out, "<!--style-->", "<style>\n" + parts.style + "</style>");
  place(out, "<!--noscript-->", fmt::format("<noscript><h1>{}</h1>\n<p class=\"note\">The figures need a browser that runs scripts. The tables below do not.</p></noscript>", escaped(title)));
  place(out, "<!--tables-->", subset_table(result) + chosen_table(result) + loadings_table(result) + dropped_table(result));
  place(out, "<!--script-->", "<script>\n" + parts.script + "</script>");
  place(out, "<!--data-->", "<script type=\"application/json\" id=\"data\">" + script_json(data) + "</script>");
  return out;
}

}  // namespace glint::report
