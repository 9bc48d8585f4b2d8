// Compares configurations and breakdowns of cycles.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/compare_causes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "report/files/config_rows.h"
#include "report/terminal/table.h"

namespace glint::report {
namespace {

struct ShareChange {
  std::string reason;
  double before = 0, after = 0;
};

// Returns each part's share of the whole in both runs.
std::vector<ShareChange> share_changes(const RunRecord& before, const RunRecord& after,
                                       const std::string& pattern) {
  std::vector<ShareChange> out;
  const auto add = [&](const RunRecord& run, double ShareChange::*side) {
    const std::vector<std::pair<std::string, double>> parts = run.parts(pattern);
    double whole = 0;
    for (const auto& [reason, value] : parts) whole += value;
    for (const auto& [reason, value] : parts) {
      const auto same =
          std::find_if(out.begin(), out.end(), [&](const ShareChange& one) { return one.reason == reason; });
      ShareChange& at = same == out.end() ? out.emplace_back(ShareChange{reason}) : *same;
      at.*side = whole > 0 ? value / whole : 0;
    }
  };
  add(before, &ShareChange::before);
  add(after, &ShareChange::after);
  std::stable_sort(out.begin(), out.end(), [](const ShareChange& a, const ShareChange& b) {
    return std::abs(a.after - a.before) > std::abs(b.after - b.before);
  });
  return out;
}

}  // namespace

std::string changed_keys_text(const std::string& before, const std::string& after) {
  const std::vector<ConfigRow> was = config_rows(before), is = config_rows(after);
  std::vector<std::vector<std::string>> rows;
  for (const ConfigChange& change : config_changes(is, was))
    rows.push_back(
        {change.row.key, change.preset.empty() ? "-" : change.preset, change.row.value, change.row.unit});
  for (const ConfigChange& change : config_changes(was, is))
    if (change.preset.empty()) rows.push_back({change.row.key, change.row.value, "-", change.row.unit});
  return rows.empty() ? "" : "\nConfiguration keys that differ\n" + table(rows, "<>><");
}

std::string changed_stalls_text(const RunRecord& before, const RunRecord& after, bool all) {
  constexpr double kTold = 0.5e-4;
  std::string out;
  for (const auto& [title, pattern] :
       {std::pair("Issue slots of the cores, by what they were spent on", "gpu.core[*].issue_slots"),
        std::pair("Cycles of the RT units, by what they were spent on", "gpu.rt_unit[*].rt.cycles")}) {
    std::vector<std::vector<std::string>> rows;
    for (const ShareChange& change : share_changes(before, after, pattern)) {
      const double points = change.after - change.before;
      if (change.before + change.after == 0 || (!all && std::abs(points) < kTold)) continue;
      rows.push_back({change.reason, fmt::format("{:.2f} %", 100 * change.before),
                      fmt::format("{:.2f} %", 100 * change.after),
                      fmt::format("{:+.2f} points", 100 * points)});
    }
    if (!rows.empty()) out += fmt::format("\n{}\n{}", title, table(rows, "<>>>"));
  }
  return out;
}

}  // namespace glint::report
