// Writes the estimates of sampled runs as tables.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/samples.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "report/files/file_list.h"
#include "report/files/run_record.h"
#include "report/metrics/compare_samples.h"
#include "report/page/parts.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::pair<std::string_view, std::string_view> kEstimates[] = {
    {"cycles", "Cycles"},
    {"ipc", "Warp instructions per cycle"},
    {"instructions", "Warp instructions"},
    {"nodes", "Nodes that rays visit"},
    {"l1_hit_rate", "L1 reads that hit"},
    {"l2_hit_rate", "L2 reads that hit"},
    {"dram_utilisation", "DRAM clocks with data"}};

bool is_sampled(const Json& run) {
  return run["run"].contains("sample") && run["run"]["sample"].is_object();
}

// Returns whether two runs did the same work.
bool is_same_work(const Json& a, const Json& b) {
  return std::ranges::all_of(
      std::array{"scene", "shader", "width", "height", "samples", "sequence"},
      [&](const char* key) { return a["run"].value(key, Json()) == b["run"].value(key, Json()); });
}

std::string label_of(const Json& run) {
  return fmt::format("{} on {} ({})", run["run"]["scene"].value("name", ""),
                     run["run"]["config"].value("name", ""), run["directory"].get<std::string>());
}

Json changes_of(const Json& before, const Json& after) {
  const auto record = [](const Json& run) { return RunRecord::read(run["directory"].get<std::string>()); };
  const auto csv = [](const Json& run) {
    return ListedFiles::of_run(run["directory"].get<std::string>()).need("sample.csv");
  };
  const SampleComparison found = compare_samples(record(before), record(after), csv(before), csv(after));
  Json changes = Json::array();
  for (const SampleChange& change : found.changes)
    changes.push_back({{"name", change.name},
                       {"before", change.before},
                       {"after", change.after},
                       {"relative", change.is_relative},
                       {"change", change.change},
                       {"low", change.low},
                       {"high", change.high},
                       {"significant", change.is_significant()}});
  return {{"how", how_compared(found)}, {"changes", std::move(changes)}};
}

// Says what was sampled.
std::string about(const Json& run) {
  const Json& sample = run["run"]["sample"];
  const std::string timed = shown(sample.value("timed", Json())), seed = shown(sample.value("seed", Json()));
  if (sample.contains("launches"))
    return fmt::format(
        "<strong>{} of {} launches were timed</strong>, from {} clusters of launches that are alike (seed "
        "{}). All launches ran functionally.",
        timed, shown(sample["launches"]), shown(sample.value("clusters", Json())), seed);
  return fmt::format(
      "<strong>{} of {} blocks were timed</strong> on 1/{} of the machine (seed {}). {} others ran "
      "functionally.",
      timed, shown(sample.value("blocks", Json())), shown(sample.value("scale", Json())), seed,
      shown(sample.value("warm", Json())));
}

// Returns a number of estimates, or a share in percent.
std::string quantity(const Json& value, bool is_share) {
  if (!value.is_number()) return "–";
  return is_share ? fmt::format("{:.1f} %", 100 * value.get<double>()) : shown(value);
}

// Returns a statistic that has one instance.
Json statistic(const Json& run, const std::string& path) {
  const Json value = run["stats"].value(path, Json());
  return value.is_array() && !value.empty() ? value[0] : value;
}

std::string interval_cells(const Json& run, std::string_view name) {
  const std::string path = fmt::format("gpu.sample.{}", name);
  const bool is_share = name.ends_with("_rate") || name.ends_with("_utilisation");
  const Json value = statistic(run, path);
  if (!value.is_number()) return "<td class=\"n\">–</td><td class=\"n\">–</td>";
  return fmt::format(
      "<td class=\"n\" data-estimate=\"{}\" data-value=\"{}\">{}</td><td class=\"n\">{} to {}</td>", name,
      value.dump(), quantity(value, is_share), quantity(statistic(run, path + "_low"), is_share),
      quantity(statistic(run, path + "_high"), is_share));
}

std::string estimates_table(const std::vector<const Json*>& runs) {
  std::string head = "<th scope=\"col\">Estimate of the whole run</th>", rows;
  for (const Json* run : runs)
    head +=
        fmt::format("<th scope=\"col\" class=\"n\">{}</th><th scope=\"col\" class=\"n\">95 % interval</th>",
                    runs.size() > 1 ? escaped(label_of(*run)) : "Value");
  for (const auto& [name, title] : kEstimates) {
    const auto has = [path = fmt::format("gpu.sample.{}", name)](const Json* run) {
      return (*run)["stats"].contains(path);
    };
    if (std::ranges::none_of(runs, has)) continue;
    rows += fmt::format("<tr><th scope=\"row\">{}</th>", title);
    for (const Json* run : runs) rows += interval_cells(*run, name);
    rows += "</tr>\n";
  }
  return fmt::format(
      "<div class=\"scroll\"><table "
      "class=\"facts\"><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n",
      head, rows);
}

std::string change_text(const Json& change, const char* key) {
  const double value = 100 * change[key].get<double>();
  return change["relative"].get<bool>() ? fmt::format("{:+.2f} %", value)
                                        : fmt::format("{:+.2f} points", value);
}

std::string changes_table(const Json& data, const Json& comparison) {
  const Json &before = data["runs"][comparison["before"].get<size_t>()],
             &after = data["runs"][comparison["after"].get<size_t>()];
  std::string rows;
  for (const Json& change : comparison["changes"]) {
    const std::string name = change["name"];
    const auto found = std::ranges::find(kEstimates, name, [](const auto& one) { return one.first; });
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td class=\"n\" data-change=\"{}\">{}</td><td class=\"n\">{} to {}</td>"
        "<td>{}</td></tr>\n",
        found->second, name, change_text(change, "change"), change_text(change, "low"),
        change_text(change, "high"),
        change["significant"].get<bool>() ? "<strong>significant</strong>" : "not significant");
  }
  return fmt::format(
      "<div class=\"scroll\"><table class=\"facts\"><caption>{} against {}</caption><thead><tr><th "
      "scope=\"col\">Estimate</th><th scope=\"col\" class=\"n\">Change</th><th scope=\"col\" class=\"n\">95 "
      "% "
      "interval</th><th scope=\"col\">Verdict</th></tr></thead><tbody>\n{}</tbody></table></div>\n<p "
      "class=\"note\">{}</p>\n",
      escaped(label_of(after)), escaped(label_of(before)), rows, escaped_text(comparison, "how"));
}

}  // namespace

nlohmann::ordered_json page_sample_changes(const nlohmann::ordered_json& runs) {
  Json out = Json::array();
  for (size_t after = 1; after < runs.size(); ++after)
    for (size_t before = 0; before < after && is_sampled(runs[after]); ++before) {
      if (!is_sampled(runs[before]) || !is_same_work(runs[before], runs[after])) continue;
      Json found = changes_of(runs[before], runs[after]);
      found["before"] = before, found["after"] = after;
      out.push_back(std::move(found));
      break;
    }
  return out;
}

std::string sample_section(const nlohmann::ordered_json& data) {
  std::vector<const Json*> runs;
  for (const Json& run : data["runs"])
    if (is_sampled(run)) runs.push_back(&run);
  if (runs.empty()) return "";
  std::string out = "<section id=\"estimates\">\n<h2>Estimates</h2>\n";
  for (const Json* run : runs)
    out += fmt::format("<p class=\"lead\">{}{}</p>\n", runs.size() > 1 ? escaped(label_of(*run)) + ": " : "",
                       about(*run));
  out += estimates_table(runs) +
         "<p class=\"note\">All other figures and tables of a sampled run count what was timed alone. They "
         "show where its "
         "time went, and no sums of the whole run.</p>\n";
  for (const Json& comparison : data.value("sample_changes", Json::array()))
    out += changes_table(data, comparison);
  return out + "</section>\n";
}

}  // namespace glint::report
