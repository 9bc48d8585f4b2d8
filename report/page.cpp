// Writing the HTML report.
// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "report/base64.h"
#include "report/image_files.h"
#include "report/page_parts.h"
#include "report/page_suite.h"
#include "report/page_tables.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLastColumns = "<th scope=\"col\">Unit</th><th scope=\"col\">Meaning</th></tr></thead>\n";

std::string title_of(const Json& run) {
  const Json& facts = run["run"];
  const std::string scene = facts["scene"].value("name", ""), shader = facts.value("shader", "");
  return shader.empty() || shader == scene ? scene : scene + " " + shader;
}

// "ship8" of "out/ship8/"
std::string folder_of(const Json& run) {
  const std::filesystem::path path = run["directory"].get<std::string>();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::string header_row(const Json& runs, std::string_view first) {
  std::string out = fmt::format("<thead><tr><th scope=\"col\">{}</th>", first);
  if (runs.size() == 1) return out + "<th scope=\"col\" class=\"n\">Value</th>";
  for (const Json& run : runs)
    out += fmt::format("<th scope=\"col\" class=\"n\" title=\"{}\">{}<small>{}</small><small>{}</small></th>", escaped(run["directory"].get<std::string>()), escaped(title_of(run)),
                       escaped(run["run"]["config"].value("name", "")), escaped(folder_of(run)));
  return out;
}

std::string metrics_table(const Json& data) {
  const Json& runs = data["runs"];
  std::string out = "<div class=\"scroll\"><table class=\"metrics\">" + header_row(runs, "Metric") + kLastColumns;
  std::string group;
  for (const Json& metric : data["metric_docs"]) {
    if (!metric["known"].get<bool>()) continue;
    const std::string name = metric["name"], unit = metric["unit"], doc = metric["doc"];
    if (metric["group"] != group) {
      group = metric["group"];
      out += fmt::format("<tbody><tr class=\"group\"><th scope=\"rowgroup\" colspan=\"{}\">{}</th></tr>\n", runs.size() + 3, escaped(group));
    }
    out += fmt::format("<tr><th scope=\"row\"><code>{}</code></th>", escaped(name));
    for (const Json& run : runs) out += fmt::format("<td class=\"n\">{}</td>", shown(run["metrics"][name]));
    out += fmt::format("<td class=\"u\">{}</td><td class=\"doc\">{}</td></tr>\n", escaped(unit), prose(doc));
  }
  return out + "</table></div>";
}

// Every key that differs from a run's preset, with the value of each run.
std::string config_table(const Json& data) {
  const Json& runs = data["runs"];
  std::string rows;
  for (const auto& [key, doc] : data["key_docs"].items()) {
    bool is_changed = false;
    std::string cells;
    for (const Json& run : runs) {
      const Json& changes = run["preset"]["changes"];
      const Json value = run["config"].value(key, Json());
      if (!changes.contains(key)) {
        cells += fmt::format("<td class=\"n\">{}</td>", shown(value));
        continue;
      }
      is_changed = true;
      cells += fmt::format("<td class=\"n changed\">{}<small>preset {}</small></td>", shown(value), shown(changes[key]));
    }
    if (is_changed) rows += fmt::format("<tr><th scope=\"row\"><code>{}</code></th>{}<td class=\"u\">{}</td><td class=\"doc\">{}</td></tr>\n", escaped(key), cells, escaped(doc["unit"].get<std::string>()), prose(doc["doc"].get<std::string>()));
  }
  std::string out;
  for (const Json& run : runs) {
    if (run["preset"]["known"].get<bool>()) continue;
    out += fmt::format("<p class=\"note\">{}: {}</p>\n", escaped(run["directory"].get<std::string>()), escaped(run["preset"]["note"].get<std::string>()));
  }
  if (rows.empty()) return out + "<p>Every key has its preset’s value.</p>\n";
  return out + "<div class=\"scroll\"><table class=\"config\">" + header_row(runs, "Key") + kLastColumns + "<tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string section(const char* id, const char* title, const char* lead, const std::string& content) {
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n<p class=\"lead\">{}</p>\n{}</section>\n", id, title, lead, content);
}

// What reads without script. The script adds its figures.
std::string static_sections(const Json& data) {
  std::string out = suite_sections(data);
  if (data["runs"].empty()) return out;
  return out + section("configuration", "Configuration", "Keys that differ from the preset the run names.", config_table(data) + "<div id=\"all-keys\"></div>\n") +
         section("metrics", "All metrics", "The numbers that characterise a workload; a dash is a number that this run does not have.", metrics_table(data)) +
         "<noscript>\n" + section("numbers", "Numbers of the figures", "What the figures show where scripts run, summed over all instances of a unit. Figures of shares and rates are among the metrics above; series over time are in series.csv.",
                                  figure_tables(data, header_row(data["runs"], "Statistic") + kLastColumns)) + "</noscript>\n";
}

std::string page_title(const Json& data) {
  const Json& runs = data["runs"];
  if (!runs.empty()) return runs.size() == 1 ? title_of(runs[0]) : fmt::format("{} runs", runs.size());
  for (const char* key : {"characterizations", "models"})
    for (const Json& one : data.value(key, Json::array()))
      if (one.contains("workloads")) return fmt::format("{} workloads", one["workloads"].size());
  return "Suite";
}

std::string pictures(const Json& data) {
  std::string out;
  for (const Json& run : data["runs"])
    if (run.contains("picture"))
      out += fmt::format("<figure><img alt=\"\" src=\"{}\"><figcaption>{}</figcaption></figure>\n", run["picture"].get<std::string>(), escaped(title_of(run)));
  return out;
}

// The script packed, under its notices, which stay readable, and what unpacks it.
std::string script_of(const PageParts& parts) {
  if (parts.unpack.empty()) return "<script>\n" + parts.script + "</script>";
  const size_t end = parts.script.starts_with("/*!") ? parts.script.find("*/") + 2 : 0;
  const std::string rest = parts.script.substr(end);
  return fmt::format("<script>\n{}\n</script>\n<script type=\"text/plain\" id=\"packed\" data-bytes=\"{}\">{}</script>\n<script>\n{}</script>", parts.script.substr(0, end), rest.size(),
                     base64(zlib_bytes(rest)), parts.unpack);
}

}  // namespace

std::string page(const nlohmann::ordered_json& data, const PageParts& parts) {
  const std::string title = page_title(data);
  std::string out = parts.frame;
  // The script goes in last: no mark is searched in it.
  place(out, "<!--title-->", escaped(title) + " – Glint report");
  place(out, "<!--style-->", "<style>\n" + parts.style + "</style>");
  place(out, "<!--noscript-->", fmt::format("<noscript><h1>{}</h1>\n{}<p class=\"note\">The figures need a browser that runs scripts. The tables below do not.</p></noscript>", escaped(title), pictures(data)));
  place(out, "<!--sections-->", static_sections(data));
  place(out, "<!--script-->", script_of(parts));
  place(out, "<!--data-->", "<script type=\"application/json\" id=\"data\">" + script_json(data) + "</script>");
  return out;
}

}  // namespace glint::report
