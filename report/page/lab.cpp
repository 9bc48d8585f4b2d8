// Writes tables of speed-ups beside the published ones.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/lab.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "report/page/parts.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

std::string column_head(const std::string& content, bool is_number) {
  return fmt::format("<th scope=\"col\"{}>{}</th>", is_number ? " class=\"n\"" : "", content);
}
std::string number_cell(const std::string& content) {
  return fmt::format("<td class=\"n\">{}</td>", content);
}
std::string factor(const Json& value) {
  return value.is_number() ? fmt::format("{:.3f}", value.get<double>()) : "–";
}
std::string band(const Json& value) {
  return value.is_array() ? fmt::format("{:g} to {:g}", value.at(0).get<double>(), value.at(1).get<double>())
                          : "–";
}

std::string table(const char* kind, const std::string& title, const std::string& head,
                  const std::string& rows) {
  return fmt::format(
      "<h3>{}</h3>\n<div class=\"scroll\"><table class=\"metrics\" "
      "data-table=\"{}\"><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n",
      title, kind, head, rows);
}

std::string comparison_row(const std::string& arm, const std::string& what, const Json& one) {
  return fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td>{}{}{}</tr>\n", arm, what,
                     number_cell(factor(one.at("here"))), number_cell(factor(one.at("published"))),
                     number_cell(band(one.at("expected"))));
}

// Returns the geometric means and figures of all arms that have a baseline and are no pair.
std::string comparison(const Json& lab) {
  std::string rows;
  for (const Json& arm : lab.at("arms")) {
    const std::string name = escaped_text(arm, "name"), against = escaped_text(arm, "against");
    if (against.empty() || arm.at("is_pair").get<bool>()) continue;
    rows += comparison_row(name, "speed-up against " + against, arm);
    for (const Json& figure : arm.at("figures"))
      rows += comparison_row(name, escaped_text(figure, "name"), figure);
  }
  if (rows.empty()) return "";
  return table("lab-arms", "Here and in the paper",
               column_head("Arm", false) + column_head("What", false) + column_head("here", true) +
                   column_head("published", true) + column_head("expected", true),
               rows);
}

// Returns the speed-up of each arm on each workload. An arm without a baseline shows its cycles.
std::string by_workload(const Json& lab) {
  std::string head = column_head("Workload", false), rows;
  std::vector<std::string> workloads;
  for (const Json& arm : lab.at("arms")) {
    if (arm.at("is_pair").get<bool>()) continue;
    head += column_head(escaped_text(arm, "name") + (escaped_text(arm, "against").empty() ? " (cycles)" : ""),
                        true);
    for (const Json& row : arm.at("workloads"))
      if (const std::string name = row.at("workload");
          std::find(workloads.begin(), workloads.end(), name) == workloads.end())
        workloads.push_back(name);
  }
  for (const std::string& workload : workloads) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th>", escaped(workload));
    for (const Json& arm : lab.at("arms")) {
      if (arm.at("is_pair").get<bool>()) continue;
      std::string cell = "–";
      for (const Json& row : arm.at("workloads"))
        if (row.at("workload") == workload)
          cell = row.at("speedup").is_null() ? shown(row.at("cycles")) : factor(row.at("speedup"));
      rows += number_cell(cell);
    }
    rows += "</tr>\n";
  }
  return table("lab-workloads", "Speed-up by workload", head, rows);
}

// Returns the speed-up of two arms together, and of one with itself where it stands alone.
std::string pair_cell(const Json& lab, const std::string& a, const std::string& b) {
  for (const Json& arm : lab.at("arms")) {
    const std::string name = arm.at("name");
    if (name == (a == b ? a : a + "+" + b) || name == b + "+" + a) return factor(arm.at("here"));
  }
  for (const Json& pair : lab.at("refused"))
    if ((pair.at("first") == a && pair.at("second") == b) ||
        (pair.at("first") == b && pair.at("second") == a))
      return fmt::format("<abbr title=\"{}\">refused</abbr>", escaped_text(pair, "reason"));
  return "–";
}

std::string pairs(const Json& lab) {
  std::vector<std::string> names;
  bool has_pairs = !lab.at("refused").empty();
  for (const Json& arm : lab.at("arms")) {
    const bool is_pair = arm.at("is_pair").get<bool>();
    has_pairs |= is_pair;
    if (!is_pair && !arm.at("against").get<std::string>().empty()) names.push_back(arm.at("name"));
  }
  if (!has_pairs) return "";
  std::string head = column_head("", false), rows;
  for (const std::string& name : names) head += column_head(escaped(name), true);
  for (const std::string& a : names) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th>", escaped(a));
    for (const std::string& b : names) rows += number_cell(pair_cell(lab, a, b));
    rows += "</tr>\n";
  }
  std::string reasons;
  for (const Json& pair : lab.at("refused"))
    reasons += fmt::format("<li>{} and {}: {}</li>\n", escaped_text(pair, "first"),
                           escaped_text(pair, "second"), escaped_text(pair, "reason"));
  return table("lab-pairs", "In pairs: geometric means of the speed-ups", head, rows) +
         (reasons.empty() ? "" : "<ul class=\"note\">\n" + reasons + "</ul>\n");
}

std::string section(const Json& lab, size_t number) {
  return fmt::format(
             "<section id=\"lab{}\">\n<h2>{}</h2>\n<p class=\"lead\">{}. Machine <code>{}</code>, {} pixels, "
             "{} spp.</p>\n<div class=\"drawn\"></div>\n",
             number ? fmt::format("-{}", number + 1) : "", escaped_text(lab, "title"),
             escaped_text(lab, "paper"), escaped_text(lab, "machine"), escaped_text(lab, "size"),
             shown(lab.at("samples"))) +
         comparison(lab) + pairs(lab) + by_workload(lab) + "</section>\n";
}

}  // namespace

Json read_lab(const std::string& text, const std::string& name) {
  Json out = Json::parse(text, nullptr, false);
  if (!out.is_object() || out.value("kind", Json()) != kLabKind)
    throw UserError({name}, "this is no result of an experiment", "`glint lab` writes lab.json");
  if (out.value("schema", Json()) != kLabSchema)
    throw UserError(
        {name}, fmt::format("it has schema {}, expected {}", out.value("schema", Json()).dump(), kLabSchema),
        "another version of Glint wrote it: run `glint lab` again with this one");
  return out;
}

std::string lab_sections(const Json& data) {
  std::string out;
  const Json list = data.value("labs", Json::array());
  for (size_t i = 0; i < list.size(); ++i) try {
      out += section(list[i], i);
    } catch (const Json::exception& error) {
      throw UserError({list[i].value("source", "")},
                      fmt::format("the experiment cannot be shown: {}", error.what()),
                      "the file is damaged: run `glint lab` again");
    }
  return out;
}

}  // namespace glint::report
