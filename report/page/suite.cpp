// Reads characterisations, and writes the report's sections about suites.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/suite.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/diagnostics.h"
#include "report/page/parts.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kLeastForR2 = 3;  // A line through two points always fits.
// This is the number of eigenvalues shown, as in the figure (web/src/characterization/scree.js). The CSV has
// all.
constexpr int kEigenvalues = 20;
constexpr double kStrongLoading = 0.7;  // a correlation of this size explains half of the variance

std::string text_of(const Json& one, const char* key) {
  return escaped(one.at(key).get<std::string>());
}
std::string share(const Json& value) {
  return fmt::format("{:.1f} %", 100 * value.get<double>());
}

std::string th(const std::string& text, bool is_number = false) {
  return fmt::format("<th scope=\"col\"{}>{}</th>", is_number ? " class=\"n\"" : "", text);
}
std::string row_head(const std::string& text) {
  return fmt::format("<tr><th scope=\"row\">{}</th>", text);
}
std::string td(const Json& value) {
  return fmt::format("<td class=\"n\">{}</td>", shown(value));
}

std::string table_html(const char* kind, const std::string& title, const std::string& head,
                       const std::string& rows) {
  return fmt::format(
      "<h3>{}</h3>\n<div class=\"scroll\"><table class=\"metrics\" "
      "data-table=\"{}\"><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n",
      title, kind, head, rows);
}

std::string folded(const std::string& summary, const std::string& content) {
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", summary, content);
}

const Json& workload(const Json& one, const Json& row) {
  return one.at("workloads").at(row.get<size_t>());
}

std::string subset_table(const Json& one) {
  std::string rows;
  for (const Json& chosen : one.at("representatives")) {
    std::string members;
    for (const Json& row : one.at("leaves"))
      if (workload(one, row).at("cluster") == chosen.at("cluster"))
        members += (members.empty() ? "" : ", ") + text_of(workload(one, row), "name");
    rows += row_head(std::to_string(chosen.at("cluster").get<int>() + 1)) +
            fmt::format("<td>{}</td>{}<td class=\"doc\">{}</td></tr>\n",
                        text_of(workload(one, chosen.at("row")), "name"), td(chosen.at("distance")), members);
  }
  std::string out = table_html("subset", "Representative subset",
                               th("Cluster") + th("Workload") + th("To centre", true) + th("Members"), rows);
  const Json& reference = one.at("reference");
  if (!reference.at("known").get<bool>()) return out;
  return out + fmt::format(
                   "<p class=\"note\">For comparison, {} has workloads of {} of the {} clusters. The mean "
                   "distance to the nearest workload of the subset, relative to the mean distance between "
                   "two workloads, is {} with it and {} with the subset above.</p>\n",
                   text_of(reference, "name"), reference.at("clusters_met").get<int>(),
                   one.at("clusters").get<int>(), share(reference.at("coverage_error")),
                   share(one.at("coverage_error")));
}

std::string chosen_table(const Json& one) {
  std::string rows;
  int number = 0;
  for (const Json& axis : one.at("axes"))
    rows += row_head(std::to_string(++number)) +
            fmt::format(
                "<td><code>{}</code></td><td class=\"n\">{:.4f}</td><td class=\"u\">{}</td><td "
                "class=\"doc\">{}</td></tr>\n",
                text_of(axis, "name"), axis.at("fitness_without").get<double>(), text_of(axis, "unit"),
                prose(axis.at("doc").get<std::string>()));
  return table_html("metrics_chosen", "Representative metrics",
                    th("") + th("Metric") + th("Correlation without it", true) + th("Unit") + th("Meaning"),
                    rows) +
         fmt::format(
             "<p class=\"note\">Distances in these {} correlate by {:.4f} with those in all {}.</p>\n",
             number, one.at("fitness").get<double>(), one.at("loadings").size());
}

std::string component_heads(const Json& one) {
  std::string out;
  for (int i = 1; i <= one.at("kept").get<int>(); ++i) out += th(fmt::format("PC{}", i), true);
  return out;
}

std::string loadings_table(const Json& one) {
  std::string rows;
  for (const Json& loading : one.at("loadings")) {
    rows += row_head("<code>" + text_of(loading, "metric") + "</code>");
    for (const Json& value : loading.at("values"))
      rows +=
          fmt::format("<td class=\"n{}\">{:.2f}</td>",
                      std::abs(value.get<double>()) >= kStrongLoading ? " changed" : "", value.get<double>());
    rows += "</tr>\n";
  }
  return table_html("loadings", "Loadings", th("Metric") + component_heads(one), rows) +
         fmt::format(
             "<p class=\"note\">The numbers are the correlation of each metric with each component. Those "
             "from {} on are marked.</p>\n",
             kStrongLoading);
}

std::string dropped_table(const Json& one) {
  std::string rows;
  for (const Json& column : one.at("dropped"))
    rows += row_head("<code>" + text_of(column, "column") + "</code>") +
            fmt::format("<td class=\"doc\">{}</td></tr>\n", text_of(column, "why"));
  return rows.empty() ? ""
                      : folded(fmt::format("Columns left out: {}", one.at("dropped").size()),
                               table_html("dropped", "Columns left out", th("Column") + th("Why"), rows));
}

// Returns the numbers of the figures for readers without script. With script, they are below each figure.
std::string figure_tables(const Json& one) {
  std::string eigenvalues, scores, joins, kiviat, axes;
  double sum = 0, total = 0;
  for (const Json& value : one.at("eigenvalues")) total += value.get<double>();
  int i = 0;
  for (const Json& value : one.at("eigenvalues")) {
    if (i == kEigenvalues) break;
    sum += value.get<double>();
    ++i;
    eigenvalues += row_head(fmt::format("PC{}", i)) + td(value) +
                   fmt::format("<td class=\"n\">{}</td><td>{}</td></tr>\n", share(sum / total),
                               i <= one.at("kept").get<int>() ? "kept" : "");
  }
  for (const Json& row : one.at("leaves")) {
    const Json& each = workload(one, row);
    const std::string head = row_head(text_of(each, "name")) +
                             fmt::format("<td class=\"n\">{}</td>", each.at("cluster").get<int>() + 1);
    scores += head, kiviat += head;
    for (const Json& value : each.at("scores")) scores += td(value);
    for (const Json& value : each.at("kiviat")) kiviat += td(value);
    scores += "</tr>\n", kiviat += "</tr>\n";
  }
  const size_t count = one.at("workloads").size();
  const auto group = [&](const Json& node) {
    return node.get<size_t>() < count ? text_of(workload(one, node), "name")
                                      : fmt::format("join {}", node.get<size_t>() - count + 1);
  };
  i = 0;
  for (const Json& join : one.at("joins"))
    joins +=
        row_head(std::to_string(++i)) + fmt::format("<td>{}</td><td>{}</td>{}{}</tr>\n", group(join.at(0)),
                                                    group(join.at(1)), td(join.at(2)), td(join.at(3)));
  for (const Json& axis : one.at("axes")) axes += th("<code>" + text_of(axis, "name") + "</code>", true);
  const std::string names = th("Workload") + th("Cluster", true);
  return "<noscript>" +
         table_html("eigenvalues", "Eigenvalues",
                    th("Component") + th("Eigenvalue", true) + th("Of the variance, so far", true) + th(""),
                    eigenvalues) +
         table_html("scores", "Scores", names + component_heads(one), scores) +
         table_html("linkage", "Dendrogram",
                    th("Join") + th("One") + th("Other") + th("Distance", true) + th("Workloads", true),
                    joins) +
         table_html("kiviat", "Kiviat diagrams: 0 is the least of all workloads, 1 the most", names + axes,
                    kiviat) +
         "</noscript>\n";
}

std::string characterization_body(const Json& one) {
  return subset_table(one) + chosen_table(one) +
         folded(fmt::format("Loadings of {} metrics", one.at("loadings").size()), loadings_table(one)) +
         dropped_table(one) + figure_tables(one);
}

std::string models_body(const Json& one) {
  const bool has_r2 = one.at("workloads").size() >= kLeastForR2;
  std::string scores, rows, head = th("Workload") + th("Simulated cycles", true);
  for (const Json& model : one.at("models")) {
    scores += row_head(text_of(model, "name")) +
              fmt::format(
                  "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{:.2f}</td><td "
                  "class=\"n\">{}</td><td>{}</td></tr>\n",
                  has_r2 ? fmt::format("{:.3f}", model.at("r2").get<double>()) : "–", share(model.at("mape")),
                  model.at("ratio").get<double>(), share(model.at("worst_error")), text_of(model, "worst"));
    head += th(text_of(model, "name"), true) + th("Error", true);
  }
  for (const Json& each : one.at("workloads")) {
    rows += row_head(text_of(each, "name")) + td(each.at("cycles"));
    for (const Json& value : each.at("predicted"))
      rows += td(std::round(value.get<double>())) +
              fmt::format("<td class=\"n\">{:+.1f} %</td>",
                          100 * (value.get<double>() / each.at("cycles").get<double>() - 1));
    rows += "</tr>\n";
  }
  return table_html("models", "How good the models are",
                    th("Model") + th("R²", true) + th("Mean error", true) +
                        th("Predicted / simulated", true) + th("Worst", true) + th(""),
                    scores) +
         "<p class=\"note\">R² is that of a regression, as the paper gives it: it does not see a constant "
         "factor, and a handful of workloads says little.</p>\n<noscript>" +
         table_html("predictions", "Predictions", head, rows) + "</noscript>\n";
}

struct Kind {
  const char *key, *id, *title, *lead, *command;
  std::string (*body)(const Json&);
};
const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kKinds = {
      {"characterizations", "characterization", "Characterisation",
       "Which workloads are alike, which of them stand for all, and which metrics tell them apart",
       "glint characterize", characterization_body},
      {"models", "models", "Models",
       "Cycles that analytical models predict, against those of the simulated machine", "glint model",
       models_body}};
  return kKinds;
}

std::string section(const Kind& kind, const Json& one, size_t number, bool is_only) {
  const std::string source = text_of(one, "source");
  std::string out =
      fmt::format("<section id=\"{}{}\">\n<h2>{}{}</h2>\n", kind.id,
                  number ? fmt::format("-{}", number + 1) : "", kind.title, is_only ? "" : ": " + source);
  if (one.contains("missing"))
    return out + fmt::format(
                     "<p class=\"note\">{}: this was not computed. <code>{}</code> computes it from these "
                     "runs without simulating them again; then make this report again.</p>\n</section>\n",
                     kind.lead, text_of(one, "missing"));
  out += fmt::format("<p class=\"lead\">{}: {} workloads of <code>{}</code>.</p>\n", kind.lead,
                     one.at("workloads").size(), source);
  if (const int differing = one.value("differing", 0); differing > 0)
    out += fmt::format(
        "<p class=\"note stale\">{} of the runs in this report {} other cycles than those from which these "
        "numbers were made: <code>{}</code> makes them again.</p>\n",
        differing, differing == 1 ? "has" : "have", kind.command);
  return out + "<div class=\"drawn\"></div>\n" + kind.body(one) + "</section>\n";
}

}  // namespace

Json read_characterization(const std::string& text, const std::string& name) {
  Json out = Json::parse(text, nullptr, false);
  if (!out.is_object() || out.value("kind", Json()) != kCharacterizationKind)
    throw UserError({name}, "this is not a characterisation",
                    "`glint characterize` writes characterization.json");
  if (out.value("schema", Json()) != kCharacterizationSchema)
    throw UserError({name},
                    fmt::format("it has schema {}, expected {}", out.value("schema", Json()).dump(),
                                kCharacterizationSchema),
                    "another version of Glint wrote it: run `glint characterize` again with this one");
  out.erase("files");  // The page has no use for the tables' sums.
  return out;
}

std::string suite_sections(const Json& data) {
  std::string out;
  for (const Kind& kind : kinds()) {
    const Json list = data.value(kind.key, Json::array());
    for (size_t i = 0; i < list.size(); ++i) try {
        out += section(kind, list[i], i, list.size() == 1);
      } catch (const Json::exception& error) {
        throw UserError({list[i].value("source", "")},
                        fmt::format("its {} cannot be shown: {}", kind.id, error.what()),
                        fmt::format("the file is damaged: run `{}` again", kind.command));
      }
  }
  return out;
}

}  // namespace glint::report
