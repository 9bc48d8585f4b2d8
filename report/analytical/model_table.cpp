// Scores models, and writes their table as text, CSV and JSON.
// SPDX-License-Identifier: Apache-2.0
#include "report/analytical/model_table.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/diagnostics.h"
#include "report/files/csv_field.h"
#include "report/files/csv_table.h"
#include "report/terminal/table.h"

namespace glint::report {
namespace {

constexpr std::string_view kModelPrefix = "model:";  // prefix of a model's column in the CSV

double number(const std::string& text, const std::string& name, int row) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    throw UserError({name, row}, fmt::format("'{}' is not a number", text),
                    "`glint model -o` writes such a table");
  return value;
}

double cycles(const std::string& text, const std::string& name, int row) {
  const double value = number(text, name, row);
  if (!std::isfinite(value) || value <= 0)
    throw UserError({name, row},
                    fmt::format("'{}' is not a number of cycles: cycles are finite and more than 0", text),
                    "the table is damaged: run `glint model` again");
  return value;
}

}  // namespace

ModelScore ModelTable::score(size_t model) const {
  ModelScore out;
  const double n = double(rows.size());
  double mean_x = 0, mean_y = 0, log_ratio = 0;
  for (const ModelRow& row : rows) {
    const double x = row.predicted[model], error = std::abs(x / row.cycles - 1);
    mean_x += x / n;
    mean_y += row.cycles / n;
    out.mean_error += error / n;
    log_ratio += std::log(x / row.cycles) / n;
    if (error >= out.worst_error) out.worst_error = error, out.worst = row.workload;
  }
  double xx = 0, yy = 0, xy = 0;
  for (const ModelRow& row : rows) {
    const double x = row.predicted[model] - mean_x, y = row.cycles - mean_y;
    xx += x * x;
    yy += y * y;
    xy += x * y;
  }
  out.r2 = xx > 0 && yy > 0 ? xy * xy / (xx * yy) : 0;
  out.ratio = std::exp(log_ratio);
  return out;
}

std::string model_text(const ModelTable& models) {
  std::vector<std::vector<std::string>> rows = {{"", "simulated"}};
  std::string alignment = "<>";
  for (const std::string& name : models.models) {
    rows[0].push_back(name);
    rows[0].push_back("");
    alignment += ">>";
  }
  for (const ModelRow& row : models.rows) {
    rows.push_back({row.workload, with_thousands(uint64_t(row.cycles))});
    for (const double value : row.predicted) {
      rows.back().push_back(with_thousands(uint64_t(std::llround(value))));
      rows.back().push_back(fmt::format("{:+.0f} %", 100 * (value / row.cycles - 1)));
    }
  }
  std::string out = table(rows, alignment) + "\n";
  std::vector<std::vector<std::string>> scores = {{"", "R2", "mean error", "predicted / simulated", "worst"}};
  for (size_t i = 0; i < models.models.size(); ++i) {
    const ModelScore score = models.score(i);
    scores.push_back({models.models[i], fmt::format("{:.3f}", score.r2), percent(score.mean_error),
                      fmt::format("{:.2f}", score.ratio),
                      fmt::format("{} ({})", percent(score.worst_error), score.worst)});
  }
  return out + table(scores, "<>>><");
}

std::string model_csv(const ModelTable& models) {
  std::string out = "workload,cycles";
  for (const std::string& name : models.models) out += "," + csv_field(std::string(kModelPrefix) + name);
  if (!models.rows.empty())
    for (const auto& [name, value] : models.rows[0].inputs) out += "," + csv_field(name);
  out += "\n";
  for (const ModelRow& row : models.rows) {
    out += fmt::format("{},{}", csv_field(row.workload), row.cycles);
    for (const double value : row.predicted) out += fmt::format(",{}", value);
    for (const auto& [name, value] : row.inputs) out += fmt::format(",{}", value);
    out += "\n";
  }
  return out;
}

ModelTable parse_models(const std::string& csv, const std::string& name) {
  const CsvTable read = read_csv(csv, name);
  if (read.columns.size() < 3 || read.columns[0] != "workload" || read.columns[1] != "cycles")
    throw UserError({name, 1}, "this is not a table of models",
                    "expected the columns workload, cycles and models: `glint model -o` writes it");
  ModelTable out;
  for (const std::string& column : read.columns)
    if (column.starts_with(kModelPrefix)) out.models.push_back(column.substr(kModelPrefix.size()));
  if (out.models.empty())
    throw UserError({name, 1}, fmt::format("there is no column '{}NAME'", kModelPrefix),
                    "this is not a table of models, or its first line is cut: `glint model -o` writes it");
  if (read.rows.empty())
    throw UserError({name, 1}, "there is no workload below the names of the columns",
                    "the table is cut: run `glint model` again");
  for (size_t i = 0; i < read.rows.size(); ++i) {
    const auto& cells = read.rows[i];
    ModelRow row{
        .workload = cells[0], .cycles = cycles(cells[1], name, int(i) + 2), .predicted = {}, .inputs = {}};
    for (size_t j = 2; j < cells.size(); ++j) {
      if (read.columns[j].starts_with(kModelPrefix))
        row.predicted.push_back(cycles(cells[j], name, int(i) + 2));
      else
        row.inputs.emplace_back(read.columns[j], number(cells[j], name, int(i) + 2));
    }
    out.rows.push_back(std::move(row));
  }
  return out;
}

nlohmann::ordered_json models_json(const ModelTable& models) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array(), workloads = nlohmann::ordered_json::array();
  for (size_t i = 0; i < models.models.size(); ++i) {
    const ModelScore score = models.score(i);
    list.push_back({{"name", models.models[i]},
                    {"r2", score.r2},
                    {"mape", score.mean_error},
                    {"ratio", score.ratio},
                    {"worst", score.worst},
                    {"worst_error", score.worst_error}});
  }
  for (const ModelRow& row : models.rows)
    workloads.push_back({{"name", row.workload}, {"cycles", row.cycles}, {"predicted", row.predicted}});
  return {{"models", std::move(list)}, {"workloads", std::move(workloads)}};
}

}  // namespace glint::report
