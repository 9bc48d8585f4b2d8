// Lists which statistics the figures draw, and lays them out row by row.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/tables.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "report/page/parts.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kBreakdowns[] = {"gpu.core[*].issue_slots",
                                            "gpu.core[*].instructions_by_class",
                                            "gpu.core[*].latency_by_class",
                                            "gpu.core[*].raygen.instructions",
                                            "gpu.core[*].raygen.latency",
                                            "gpu.core[*].intersection.instructions",
                                            "gpu.core[*].intersection.latency",
                                            "gpu.core[*].any_hit.instructions",
                                            "gpu.core[*].any_hit.latency",
                                            "gpu.core[*].closest_hit.instructions",
                                            "gpu.core[*].closest_hit.latency",
                                            "gpu.core[*].miss.instructions",
                                            "gpu.core[*].miss.latency",
                                            "gpu.core[*].callable.instructions",
                                            "gpu.core[*].callable.latency",
                                            "gpu.core[*].compute.instructions",
                                            "gpu.core[*].compute.latency",
                                            "gpu.rt_unit[*].rt.cycles",
                                            "gpu.memory.core[*].l1.reads",
                                            "gpu.memory.core[*].l1.hits",
                                            "gpu.memory.core[*].l1.pending_hits",
                                            "gpu.memory.core[*].l1.misses",
                                            "gpu.memory.core[*].l1.cold_misses",
                                            "gpu.memory.core[*].l1.miss_stages",
                                            "gpu.memory.partition[*].l2.reads",
                                            "gpu.memory.partition[*].l2.hits",
                                            "gpu.memory.partition[*].l2.pending_hits",
                                            "gpu.memory.partition[*].l2.misses",
                                            "gpu.memory.partition[*].l2.cold_misses",
                                            "gpu.memory.partition[*].dram.use"};
constexpr std::string_view kHistograms[] = {
    "gpu.rt_unit[*].rt.ray_nodes", "gpu.rt_unit[*].rt.ray_latency", "gpu.memory.core[*].l1.miss_latency",
    "gpu.memory.core[*].l1.l2_latency", "gpu.memory.core[*].l1.dram_latency"};

struct PartRow {
  std::string name;
  std::vector<uint64_t> values;  // one for each run
};

uint64_t largest(const PartRow& row) {
  return *std::max_element(row.values.begin(), row.values.end());
}

// Returns the sum of all instances. When all are 0, there is one 0 (page_stats).
uint64_t sum_of(const Json& run, const std::string& path) {
  const auto found = run["stats"].find(path);
  if (found == run["stats"].end()) return 0;
  if (!found->is_array()) return found->get<uint64_t>();
  uint64_t sum = 0;
  for (const Json& value : *found) sum += value.get<uint64_t>();
  return sum;
}

std::vector<PartRow> parts_of(const Json& runs, const std::string& path) {
  std::vector<PartRow> rows;
  for (const Json& run : runs)
    for (const auto& [key, value] : run["stats"].items()) {
      if (!key.starts_with(path + "::")) continue;
      const std::string part = key.substr(path.size() + 2);
      if (std::any_of(rows.begin(), rows.end(), [&](const PartRow& row) { return row.name == part; }))
        continue;
      PartRow& row = rows.emplace_back(PartRow{part, {}});
      for (const Json& one : runs) row.values.push_back(sum_of(one, key));
    }
  return rows;
}

// Returns the bins of a histogram, such as "500 to 999 cycle". The bins' unit is in their names, because the
// values are counts.
std::vector<PartRow> bins_of(const Json& runs, const std::string& path, const Json& docs) {
  const Json& bins = docs.at("bins");
  const std::string unit = docs.at("unit");
  const uint64_t low = bins["low"], high = bins["high"], step = bins["step"];
  std::vector<PartRow> rows;
  for (uint64_t from = low; from < high; from += step) {
    const bool is_last = from + step >= high;
    rows.push_back({is_last ? fmt::format("{} {} and more", from, unit)
                            : fmt::format("{} to {} {}", from, from + step - 1, unit),
                    std::vector<uint64_t>(runs.size())});
  }
  for (size_t i = 0; i < runs.size(); ++i) {
    const auto found = runs[i]["stats"].find(path);
    if (found == runs[i]["stats"].end() || !found->is_array()) continue;
    for (const Json& instance : *found)
      for (size_t bin = 0; instance.is_array() && bin < std::min(instance.size(), rows.size()); ++bin)
        rows[bin].values[i] += instance[bin].get<uint64_t>();
  }
  return rows;
}

// Returns the ops with the largest values first.
std::vector<PartRow> ops_of(const Json& runs, const char* field) {
  std::vector<PartRow> rows;
  for (size_t i = 0; i < runs.size(); ++i)
    for (const Json& op : runs[i].contains("profile") ? runs[i]["profile"]["ops"] : Json::array()) {
      const std::string name = op["name"];
      auto row = std::find_if(rows.begin(), rows.end(), [&](const PartRow& one) { return one.name == name; });
      if (row == rows.end()) row = rows.insert(row, {name, std::vector<uint64_t>(runs.size())});
      row->values[i] = op[field];
    }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const PartRow& a, const PartRow& b) { return largest(a) > largest(b); });
  if (rows.size() > kOpsInTables) rows.resize(kOpsInTables);
  return rows;
}

// Returns one group of rows under its name, or "" when all are 0.
std::string group(const std::string& name, const std::string& unit, const std::string& doc,
                  const std::vector<PartRow>& rows, size_t num_runs) {
  std::string lines;
  for (const PartRow& row : rows) {
    if (largest(row) == 0) continue;
    lines += fmt::format("<tr><th scope=\"row\">{}</th>", escaped(row.name));
    for (const uint64_t value : row.values) lines += fmt::format("<td class=\"n\">{}</td>", shown(value));
    lines += fmt::format("<td class=\"u\">{}</td><td></td></tr>\n", escaped(unit));
  }
  if (lines.empty()) return "";
  return fmt::format(
      "<tbody data-of=\"{}\"><tr class=\"group\"><th scope=\"rowgroup\" "
      "colspan=\"{}\"><code>{}</code></th><td class=\"doc\">{}</td></tr>\n{}</tbody>\n",
      escaped(name), num_runs + 2, escaped(name), prose(doc), lines);
}

}  // namespace

std::string figure_tables(const nlohmann::ordered_json& data, const std::string& head) {
  const Json& runs = data["runs"];
  if (runs.size() > kMaxRunsInTables)
    return fmt::format(
        "<p class=\"note\">Without script the numbers of figures are shown for at most {} runs; stats.csv of "
        "a run has all of them.</p>\n",
        kMaxRunsInTables);
  std::string groups;
  const Json& docs = data.at("stat_docs");
  for (const std::string_view one : kBreakdowns)
    if (const std::string path(one); docs.contains(path))
      groups += group(path, docs[path]["unit"], docs[path]["doc"], parts_of(runs, path), runs.size());
  for (const std::string_view one : kHistograms)
    if (const std::string path(one); docs.contains(path))
      groups += group(path, "count", docs[path]["doc"], bins_of(runs, path, docs[path]), runs.size());
  groups += group("profile: ops by count", "instruction",
                  "Number of warp instructions issued, for the ops with most.", ops_of(runs, "issues"),
                  runs.size());
  groups += group("profile: ops by scheduler cycles", "cycle",
                  "Cycles of schedulers that issued the op, or whose warp nearest to issue waited at it.",
                  ops_of(runs, "cycles"), runs.size());
  groups += group("profile: ops by latency", "cycle",
                  "Cycles from issue to completion of accesses that went to the L1 and of traces, summed.",
                  ops_of(runs, "latency"), runs.size());
  return "<div class=\"scroll\"><table class=\"metrics\">" + head + groups + "</table></div>\n";
}

}  // namespace glint::report
