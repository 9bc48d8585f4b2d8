// Writes tables of points and of failures.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/collection.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <vector>

#include "report/page/frame_bars.h"
#include "report/page/parts.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMainMetrics[] = {"cycles",       "thread_ipc", "simt_efficiency", "l1d_miss_rate",
                                        "l2_miss_rate", "dram_util",  "rt_occupancy",    "rt_efficiency"};

const Json* run_of(const Json& data, const Json& point) {
  for (const Json& run : data["runs"])
    if (run["directory"] == point["directory"]) return &run;
  return nullptr;
}

// Returns the value of a swept key in a run; "config" is the preset.
Json value_of(const Json& run, const std::string& key) {
  return key == "config" ? run["run"]["config"].value("name", Json()) : run["config"].value(key, Json());
}

std::string head_cell(const std::string& content, const std::string& title = "") {
  return fmt::format("<th scope=\"col\" class=\"n\"{}>{}</th>",
                     title.empty() ? "" : fmt::format(" title=\"{}\"", title), content);
}

std::string points_table(const Json& data, const Json& one) {
  std::string head = "<th scope=\"col\">Point</th>", rows;
  for (const Json& key : one["keys"])
    head += head_cell("<code>" + escaped(key.get<std::string>()) + "</code>");
  for (const char* name : kMainMetrics)
    for (const Json& metric : data["metric_docs"])
      if (metric["name"] == name)
        head += head_cell(fmt::format("<code>{}</code>", name),
                          fmt::format("{} ({})", escaped_text(metric, "doc"), escaped_text(metric, "unit")));
  for (const Json& point : one["points"]) {
    const Json* const run = run_of(data, point);
    if (!run) continue;
    rows += fmt::format("<tr><th scope=\"row\"><a href=\"{}\">{}</a></th>", escaped_text(point, "link"),
                        escaped_text(point, "name"));
    for (const Json& key : one["keys"])
      rows += fmt::format("<td class=\"n\">{}</td>", shown(value_of(*run, key)));
    for (const char* name : kMainMetrics)
      rows += fmt::format("<td class=\"n\">{}</td>", shown((*run)["metrics"].value(name, Json())));
    rows += "</tr>\n";
  }
  return fmt::format(
      "<div class=\"scroll\"><table class=\"metrics\" "
      "data-table=\"points\"><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n",
      head, rows);
}

// Returns the figure over the axis of frames, or "" for what is no sequence of frames.
std::string figure_of(const Json& data, const Json& one) {
  if (one["kind"] != "frames") return "";
  std::vector<const Json*> runs;
  for (const Json& point : one["points"]) runs.push_back(run_of(data, point));
  return frame_bars(one["points"], runs, data["metric_docs"]);
}

std::string failed_table(const Json& one) {
  std::string rows;
  for (const Json& failed : one["failed"])
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"doc\">{}</td></tr>\n",
                        escaped_text(failed, "name"), escaped_text(failed, "reason"));
  return fmt::format(
      "<div class=\"scroll\"><table class=\"metrics\" data-table=\"failed\"><thead><tr><th "
      "scope=\"col\">Run</th><th scope=\"col\">Why it is not here</th></tr></thead><tbody>\n"
      "{}</tbody></table></div>\n",
      rows);
}

// Says how a kind of collection is shown.
struct Kind {
  const char *id, *title;
  const char* lead;  // its arguments are the points, all of them with those that failed, and the folder
};
Kind kind_of(const Json& one) {
  if (one["kind"] == "sweep")
    return {"sweep", "Sweep",
            "{} of {} points of <code>{}</code> are complete. Each name leads to the point's own report."};
  if (one["kind"] == "launches")
    return {
        "launches", "Launches",
        "{} of {} launches of <code>{}</code> are complete, in the order in which they ran. The run's own "
        "numbers are their sum. Each name leads to the launch's own report."};
  if (one["kind"] == "frames")
    return {"frames", "Frames",
            "{} of {} frames of <code>{}</code> are complete, in the order in which they ran. The run's own "
            "numbers are their sum. Each name leads to the frame's own report."};
  return {"failed", "Workloads that failed", ""};
}

std::string section(const Json& data, const Json& one, size_t number) {
  const Kind kind = kind_of(one);
  const bool has_table = *kind.lead != 0;
  const size_t failed = one["failed"].size(), points = one["points"].size();
  if (!has_table && failed == 0) return "";
  std::string out = fmt::format("<section id=\"{}{}\">\n<h2>{}</h2>\n", kind.id,
                                number ? fmt::format("-{}", number + 1) : "", kind.title);
  if (has_table)
    out += "<p class=\"lead\">" +
           fmt::format(fmt::runtime(kind.lead), points, points + failed, escaped_text(one, "source")) +
           "</p>\n" + figure_of(data, one) + points_table(data, one);
  else
    out += fmt::format(
        "<p class=\"lead\"><code>{}</code> has {} not in its metrics.csv, and so not on this page.</p>\n",
        escaped_text(one, "source"), failed == 1 ? "1 run that is" : fmt::format("{} runs that are", failed));
  return out + (failed ? failed_table(one) : "") + "</section>\n";
}

}  // namespace

std::string collection_sections(const Json& data) {
  std::string out;
  const Json list = data.value("collections", Json::array());
  for (size_t i = 0; i < list.size(); ++i) out += section(data, list[i], i);
  return out;
}

}  // namespace glint::report
