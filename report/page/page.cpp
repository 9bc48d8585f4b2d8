// Writes the HTML report.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/page.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "report/page/application.h"
#include "report/page/collection.h"
#include "report/page/columns.h"
#include "report/page/lab.h"
#include "report/page/parts.h"
#include "report/page/samples.h"
#include "report/page/suite.h"
#include "report/page/tables.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLastColumns =
    "<th scope=\"col\">Unit</th><th scope=\"col\">Meaning</th></tr></thead>\n";
constexpr std::string_view kKeyMetrics[] = {
    "cycles",    "thread_ipc",   "simt_efficiency", "l1d_miss_rate", "l2_miss_rate",
    "dram_util", "rt_occupancy", "rt_efficiency",   "rays_total",    "avg_nodes_per_ray"};

std::string title_of(const Json& run) {
  const Json& facts = run["run"];
  const std::string scene = facts["scene"].value("name", ""), shader = facts.value("shader", "");
  return (shader.empty() || shader == scene ? scene : scene + " " + shader) +
         (facts.contains("partial") ? ", partial" : "");
}

// Says which runs were ended early, because their figures stand for a part of the launch.
std::string partial_runs(const Json& runs) {
  std::string out;
  for (const Json& run : runs)
    if (run["run"].contains("partial"))
      out += fmt::format(
          "<p class=\"note\"><strong>{} is partial</strong>: {}. All its figures are those up to "
          "there.</p>\n",
          escaped(run["directory"].get<std::string>()), escaped(run["run"].value("message", "")));
  return out;
}

// Returns the folder of a run: "ship8" of "out/ship8/".
std::string folder_of(const Json& run) {
  const std::filesystem::path path = run["directory"].get<std::string>();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::string header_row(const Json& runs, std::string_view first) {
  std::string out = fmt::format("<thead><tr><th scope=\"col\">{}</th>", first);
  if (runs.size() == 1) return out + "<th scope=\"col\" class=\"n\">Value</th>";
  for (const Json& run : runs)
    out += fmt::format("<th scope=\"col\" class=\"n\" title=\"{}\">{}<small>{}</small><small>{}</small></th>",
                       escaped(run["directory"].get<std::string>()), escaped(title_of(run)),
                       escaped(run["run"]["config"].value("name", "")), escaped(folder_of(run)));
  return out;
}

// Returns a table of all metrics with a column for each run.
std::string all_metrics(const Json& data) {
  const Json& runs = data["runs"];
  std::string out =
      "<div class=\"scroll\"><table class=\"metrics\">" + header_row(runs, "Metric") + kLastColumns;
  std::string group;
  for (const Json& metric : data["metric_docs"]) {
    if (!metric["known"].get<bool>()) continue;
    const std::string name = metric["name"], unit = metric["unit"], doc = metric["doc"];
    if (metric["group"] != group) {
      group = metric["group"];
      out += fmt::format("<tbody><tr class=\"group\"><th scope=\"rowgroup\" colspan=\"{}\">{}</th></tr>\n",
                         runs.size() + 3, escaped(group));
    }
    out += fmt::format("<tr><th scope=\"row\"><code>{}</code></th>", escaped(name));
    for (const Json& run : runs) out += fmt::format("<td class=\"n\">{}</td>", shown(run["metrics"][name]));
    out += fmt::format("<td class=\"u\">{}</td><td class=\"doc\">{}</td></tr>\n", escaped(unit), prose(doc));
  }
  return out + "</table></div>";
}

// Returns a table of the key figures with a row for each run. With all metrics of many runs it would be an
// eighth of the page, and wider than any screen.
std::string key_metrics(const Json& data) {
  std::string head = "<th scope=\"col\">Run</th><th scope=\"col\">Folder</th>", rows;
  std::vector<std::string> names;
  for (const Json& metric : data["metric_docs"]) {
    const std::string name = metric["name"], unit = metric["unit"], doc = metric["doc"];
    if (std::find(std::begin(kKeyMetrics), std::end(kKeyMetrics), name) == std::end(kKeyMetrics)) continue;
    names.push_back(name);
    head += fmt::format("<th scope=\"col\" class=\"n\" title=\"{} ({})\"><code>{}</code></th>", escaped(doc),
                        escaped(unit), escaped(name));
  }
  for (const Json& run : data["runs"]) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td>", escaped(title_of(run)),
                        escaped(folder_of(run)));
    for (const std::string& name : names)
      rows += fmt::format("<td class=\"n\">{}</td>", shown(run["metrics"].value(name, Json())));
    rows += "</tr>\n";
  }
  return fmt::format(
      "<p class=\"note\">Without script this page has only the key figures of its {} runs, as "
      "docs/metrics.md has them. <code>glint stats RUN --format metrics</code> prints all {} metrics of "
      "one.</p>\n"
      "<div class=\"scroll\"><table "
      "class=\"metrics\"><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>",
      data["runs"].size(), data["metric_docs"].size(), head, rows);
}

// Returns the table for readers without script. The script draws the table of all metrics itself.
std::string metrics_table(const Json& data) {
  return "<div id=\"all-metrics\"></div>\n<noscript>" +
         (data["runs"].size() <= kMaxRunsInTables ? all_metrics(data) : key_metrics(data)) + "</noscript>\n";
}

// Returns the presets that the runs' configurations are compared with, such as "mobile, desktop".
std::string presets_of(const Json& runs) {
  std::vector<std::string> names;
  for (const Json& run : runs)
    if (const std::string name = run["preset"]["name"];
        std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  return escaped(fmt::format("{}", fmt::join(names, ", ")));
}

std::string config_lead(const Json& runs) {
  return fmt::format("This table lists the keys whose value is not that of {}{}.",
                     runs.size() > 1 ? "the run’s preset: " : "", presets_of(runs));
}

// Says for configurations that are not presets which preset they are compared with.
std::string own_files(const Json& runs) {
  std::string out;
  for (const Json& run : runs) {
    const std::string name = run["run"]["config"].value("name", ""), preset = run["preset"]["name"];
    const std::string line = fmt::format(
        "<p class=\"note\"><code>{}</code> is not a preset: the run’s own copy of it is compared with "
        "{}.</p>\n",
        escaped(name), escaped(preset));
    if (name != preset && out.find(line) == std::string::npos) out += line;
  }
  return out;
}

// Returns a table of every key that differs from a run's preset, with the value of each run.
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
      cells += fmt::format("<td class=\"n changed\">{}<small>{} {}</small></td>", shown(value),
                           escaped(run["preset"]["name"].get<std::string>()), shown(changes[key]));
    }
    if (is_changed)
      rows += fmt::format(
          "<tr><th scope=\"row\"><code>{}</code></th>{}<td class=\"u\">{}</td><td "
          "class=\"doc\">{}</td></tr>\n",
          escaped(key), cells, escaped(doc["unit"].get<std::string>()), prose(doc["doc"].get<std::string>()));
  }
  const std::string out = own_files(runs);
  if (rows.empty())
    return out + fmt::format("<p>Every key has the value of {}{}.</p>\n",
                             runs.size() > 1 ? "its run’s preset: " : "", presets_of(runs));
  return out + "<div class=\"scroll\"><table class=\"config\">" + header_row(runs, "Key") + kLastColumns +
         "<tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string section(const char* id, const char* title, const char* lead, const std::string& content) {
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n<p class=\"lead\">{}</p>\n{}</section>\n", id, title,
                     lead, content);
}

// Returns the sections that can be read without script. The script adds its figures.
std::string static_sections(const Json& data) {
  std::string out = partial_runs(data["runs"]) + sample_section(data) + application_sections(data) +
                    collection_sections(data) + lab_sections(data) + suite_sections(data);
  if (data["runs"].empty()) return out;
  return out +
         section("configuration", "Configuration", config_lead(data["runs"]).c_str(),
                 config_table(data) + "<div id=\"all-keys\"></div>\n") +
         section("metrics", "All metrics",
                 "These numbers characterise a workload. A dash is a number that this run does not have.",
                 metrics_table(data)) +
         "<noscript>\n" +
         section("numbers", "Numbers of the figures",
                 "These are the numbers that the figures show where scripts run, summed over all instances "
                 "of a unit. Figures of shares and rates are among the metrics above, and series over time "
                 "are in series.csv.",
                 figure_tables(data, header_row(data["runs"], "Statistic") + kLastColumns)) +
         "</noscript>\n";
}

std::string page_title(const Json& data) {
  const Json& runs = data["runs"];
  if (!runs.empty()) return runs.size() == 1 ? title_of(runs[0]) : fmt::format("{} runs", runs.size());
  for (const Json& one : data.value("applications", Json::array())) return one["index"]["program"];
  for (const Json& lab : data.value("labs", Json::array())) return lab.value("name", "Experiment");
  for (const char* key : {"characterizations", "models"})
    for (const Json& one : data.value(key, Json::array()))
      if (one.contains("workloads")) return fmt::format("{} workloads", one["workloads"].size());
  return "Suite";
}

std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string picture(size_t run, const std::string& map, const Json& source, const std::string& caption) {
  return fmt::format(
      "<figure><img alt=\"\" data-run=\"{}\" data-map=\"{}\" "
      "src=\"{}\"><figcaption>{}</figcaption></figure>\n",
      run, escaped(map), source.get<std::string>(), escaped(caption));
}

// Returns each picture once. The script takes them from here (web/src/document.js).
std::string pictures(const Json& data) {
  std::string out;
  const Json& runs = data["runs"];
  for (size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].contains("picture")) out += picture(i, "", runs[i]["picture"], title_of(runs[i]));
    size_t number = 0;
    for (const Json& image : runs[i].value("images", Json::array()))
      out += picture(i, fmt::format("image:{}", number++), image["picture"],
                     fmt::format("{}: {} ({})", title_of(runs[i]), image["name"].get<std::string>(),
                                 image["file"].get<std::string>()));
    for (const Json& map : runs[i].value("heat", Json::array()))
      out += picture(i, map["name"], map["picture"],
                     fmt::format("{}: {}, dark 0 to bright {} ({})", title_of(runs[i]), spaced(map["name"]),
                                 shown(map["top"]), map["unit"].get<std::string>()));
  }
  return out;
}

// Returns the packed script below its notices, which stay readable, and then the script that unpacks it.
std::string script_of(const PageParts& parts) {
  const size_t end = parts.script.starts_with("/*!") ? parts.script.find("*/") + 2 : 0;
  return fmt::format("<script>\n{}\n</script>\n{}\n<script>\n{}</script>", parts.script.substr(0, end),
                     packed_element("script", std::string_view(parts.script).substr(end)), parts.unpack);
}

}  // namespace

std::string page(const nlohmann::ordered_json& data, const PageParts& parts) {
  const std::string title = page_title(data);
  std::string out = parts.frame;
  // The script goes in last, so that no mark is searched for in it.
  place(out, "<!--title-->", escaped(title) + " – Glint report");
  place(out, "<!--style-->", "<style>\n" + parts.style + "</style>");
  place(out, "<!--noscript-->",
        fmt::format("<noscript id=\"pictures\"><h1>{}</h1>\n{}<p class=\"note\">The figures need a browser "
                    "that runs scripts. The tables below do not.</p></noscript>",
                    escaped(title), pictures(data)));
  place(out, "<!--sections-->", static_sections(data));
  place(out, "<!--script-->", script_of(parts));
  place(out, "<!--data-->",
        packed_element("data", page_columns(data).dump(-1, ' ', false, Json::error_handler_t::replace)));
  return out;
}

}  // namespace glint::report
