// Computes speed-ups and figures of arms, and writes them as tables.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/lab/results.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/glint/bench/tables.h"
#include "base/diagnostics.h"
#include "report/files/csv_field.h"
#include "report/files/run_record.h"
#include "report/metrics/formula.h"
#include "report/page/lab.h"
#include "report/terminal/table.h"

namespace glint::app {

using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kCycles = "sum(gpu.cycles)";

using RunsByWorkload = std::map<std::string, report::RunRecord>;  // by workload

RunsByWorkload runs_of(const std::string& folder) {
  RunsByWorkload out;
  for (const auto& [workload, directory] : finished_runs(folder))
    out.emplace(workload, report::RunRecord::read(directory));
  return out;
}

std::optional<double> mean(const std::vector<std::optional<double>>& values, bool is_geometric) {
  double sum = 0;
  size_t count = 0;
  for (const std::optional<double>& value : values) {
    if (!value || (is_geometric && *value <= 0)) continue;
    sum += is_geometric ? std::log(*value) : *value;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return is_geometric ? std::exp(sum / double(count)) : sum / double(count);
}

std::optional<double> quotient(std::optional<double> above, std::optional<double> below) {
  if (!above || !below || *below == 0) return std::nullopt;
  return *above / *below;
}

LabRow row_of(const LabArm& arm, const std::string& workload, const report::RunRecord& run,
              const report::RunRecord* baseline) {
  LabRow row{workload, report::evaluate(kCycles, run).value_or(0), {}, {}};
  if (baseline) row.speedup = quotient(report::evaluate(kCycles, *baseline), row.cycles);
  for (const LabFigure& figure : arm.figures) {
    std::optional<double> value = report::evaluate(figure.formula, run);
    if (figure.is_ratio)
      value = baseline ? quotient(value, report::evaluate(figure.formula, *baseline)) : std::nullopt;
    row.figures.push_back(value);
  }
  return row;
}

LabResult result_of(const LabArm& arm, const RunsByWorkload& runs, const RunsByWorkload* baselines) {
  LabResult out{&arm, {}, {}, {}};
  std::vector<std::optional<double>> speedups;
  for (const auto& [workload, run] : runs) {
    const report::RunRecord* baseline = nullptr;
    if (baselines) {
      const auto found = baselines->find(workload);
      if (found == baselines->end())
        throw UserError(fmt::format("the arm '{}' has no run of {} to compare '{}' with", arm.against,
                                    workload, arm.name));
      baseline = &found->second;
    }
    out.rows.push_back(row_of(arm, workload, run, baseline));
    speedups.push_back(out.rows.back().speedup);
  }
  out.geomean = mean(speedups, true);
  for (size_t i = 0; i < arm.figures.size(); ++i) {
    std::vector<std::optional<double>> values;
    for (const LabRow& row : out.rows) values.push_back(row.figures[i]);
    out.figures.push_back(mean(values, arm.figures[i].is_ratio));
  }
  return out;
}

std::string shown(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "-";
}
std::string shown(const std::optional<Band>& band) {
  return band ? fmt::format("{:g} to {:g}", band->low, band->high) : "-";
}
std::string verdict(const std::optional<Band>& band, const std::optional<double>& value) {
  if (!band) return "";
  return value && band->has(*value) ? "as expected" : "NOT as expected";
}

// Returns the lines that say how an arm stands against what was published.
std::vector<std::vector<std::string>> summary_rows(const LabResult& result) {
  const LabArm& arm = *result.arm;
  std::vector<std::vector<std::string>> out;
  if (!arm.against.empty())
    out.push_back({arm.name, "speed-up against " + arm.against, shown(result.geomean), shown(arm.published),
                   shown(arm.expected), verdict(arm.expected, result.geomean)});
  if (arm.least) {
    double worst = HUGE_VAL;
    for (const LabRow& row : result.rows) worst = std::min(worst, row.speedup.value_or(HUGE_VAL));
    out.push_back({arm.name, "least speed-up of a workload", shown(worst), "-",
                   fmt::format("{:g} or more", *arm.least),
                   worst >= *arm.least ? "as expected" : "NOT as expected"});
  }
  for (size_t i = 0; i < arm.figures.size(); ++i) {
    const LabFigure& figure = arm.figures[i];
    out.push_back({arm.name, figure.name, shown(result.figures[i]), shown(figure.published),
                   shown(figure.expected), verdict(figure.expected, result.figures[i])});
  }
  return out;
}

}  // namespace

std::optional<bool> LabResult::holds() const {
  std::optional<bool> out;
  const auto note = [&out](bool is_so) { out = out.value_or(true) && is_so; };
  if (arm->expected) note(geomean && arm->expected->has(*geomean));
  if (arm->least)
    for (const LabRow& row : rows) note(row.speedup && *row.speedup >= *arm->least);
  for (size_t i = 0; i < figures.size(); ++i)
    if (const auto& band = arm->figures[i].expected) note(figures[i] && band->has(*figures[i]));
  return out;
}

std::optional<bool> LabResult::has_published_sign() const {
  if (!arm->published || !geomean) return std::nullopt;
  return (*arm->published > 1) == (*geomean > 1);
}

std::vector<LabResult> lab_results(const Experiment& experiment, const std::string& folder) {
  std::map<std::string, RunsByWorkload> runs;
  for (const LabArm& arm : experiment.arms) runs[arm.name] = runs_of(folder + "/" + arm.name);
  std::vector<LabResult> out;
  for (const LabArm& arm : experiment.arms)
    out.push_back(result_of(arm, runs[arm.name], arm.against.empty() ? nullptr : &runs[arm.against]));
  return out;
}

std::string lab_table(const Experiment& experiment, const std::vector<LabResult>& all) {
  std::vector<LabResult> results = all;
  std::erase_if(results,
                [](const LabResult& result) { return result.arm->is_pair; });  // pair_table() has them
  std::vector<std::string> head{"workload"};
  std::map<std::string, std::vector<std::string>> lines;  // by workload
  for (const LabResult& result : results) {
    head.push_back(result.arm->against.empty() ? result.arm->name + " (cycles)" : result.arm->name);
    for (const LabRow& row : result.rows) lines[row.workload];
  }
  for (auto& [workload, line] : lines)
    for (const LabResult& result : results) {
      const auto row = std::find_if(result.rows.begin(), result.rows.end(),
                                    [&](const LabRow& one) { return one.workload == workload; });
      line.push_back(row == result.rows.end() ? "-"
                     : row->speedup           ? shown(row->speedup)
                                              : report::with_thousands(uint64_t(row->cycles)));
    }
  std::vector<std::vector<std::string>> speedups{head},
      summary{{"arm", "what", "here", "published", "expected", ""}};
  for (const auto& [workload, line] : lines) {
    speedups.push_back({workload});
    speedups.back().insert(speedups.back().end(), line.begin(), line.end());
  }
  for (const LabResult& result : results)
    for (auto& row : summary_rows(result)) summary.push_back(std::move(row));
  return fmt::format("{}\n{}\nmachine: {}\n\n{}\n{}", experiment.title, experiment.source, experiment.config,
                     report::table(speedups, "<" + std::string(head.size(), '>')),
                     report::table(summary, "<<>>>"));
}

std::string lab_csv(const std::vector<LabResult>& results) {
  std::string out = "arm,against,workload,cycles,speedup,figure,value\n";
  for (const LabResult& result : results)
    for (const LabRow& row : result.rows) {
      const std::string start = fmt::format("{},{},{},{},{}", report::csv_field(result.arm->name),
                                            report::csv_field(result.arm->against), row.workload, row.cycles,
                                            row.speedup ? fmt::format("{}", *row.speedup) : "");
      out += start + ",,\n";
      for (size_t i = 0; i < row.figures.size(); ++i)
        out += fmt::format("{},{},{}\n", start, report::csv_field(result.arm->figures[i].name),
                           row.figures[i] ? fmt::format("{}", *row.figures[i]) : "");
    }
  return out;
}

Json lab_json(const Experiment& experiment, const std::vector<LabResult>& results) {
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  const auto band = [](const std::optional<Band>& value) {
    return value ? Json::array({value->low, value->high}) : Json();
  };
  Json arms = Json::array();
  for (const LabResult& result : results) {
    const LabArm& arm = *result.arm;
    Json rows = Json::array(), figures = Json::array();
    for (const LabRow& row : result.rows)
      rows.push_back({{"workload", row.workload}, {"cycles", row.cycles}, {"speedup", number(row.speedup)}});
    for (size_t i = 0; i < arm.figures.size(); ++i)
      figures.push_back({{"name", arm.figures[i].name},
                         {"here", number(result.figures[i])},
                         {"published", number(arm.figures[i].published)},
                         {"expected", band(arm.figures[i].expected)}});
    arms.push_back({{"name", arm.name},
                    {"against", arm.against},
                    {"is_pair", arm.is_pair},
                    {"here", number(result.geomean)},
                    {"published", number(arm.published)},
                    {"expected", band(arm.expected)},
                    {"workloads", rows},
                    {"figures", figures}});
  }
  return {{"kind", report::kLabKind},  {"schema", report::kLabSchema},  {"name", experiment.name},
          {"title", experiment.title}, {"paper", experiment.source},    {"machine", experiment.config},
          {"size", experiment.size},   {"samples", experiment.samples}, {"arms", arms},
          {"refused", Json::array()}};
}

}  // namespace glint::app
