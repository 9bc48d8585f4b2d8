// Reads a table of metrics and decides which columns take part.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/feature_table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"
#include "report/files/csv_field.h"
#include "report/files/csv_table.h"

namespace glint::report {
namespace {

constexpr Eigen::Index kFewestWorkloads = 3, kFewestMetrics = 2;
// These columns say which run it was (metrics_header()) and not how it behaved.
constexpr std::string_view kIdentity[] = {"scene",    "form",  "shader", "config", "config_hash",
                                          "fraction", "width", "height", "samples"};
constexpr std::string_view kHostSpeed = "sim_rate";

struct Column {
  std::vector<double> values;
  std::string why;  // the reason why the column is dropped; "": it takes part
};

Column read_column(const CsvTable& table, size_t index) {
  Column out;
  size_t num_empty = 0;
  for (const std::vector<std::string>& row : table.rows) {
    const std::string& cell = row[index];
    const std::optional<double> value = finite_number(cell);
    num_empty += cell.empty();
    if (!value && !cell.empty()) {
      out.why = fmt::format("'{}' is not a number", cell);
      return out;
    }
    out.values.push_back(value.value_or(0));
  }
  if (num_empty == table.rows.size())
    out.why = "empty";
  else if (num_empty)
    out.why = fmt::format("empty for {} of {} workloads", num_empty, table.rows.size());
  else if (std::ranges::all_of(out.values, [&](double value) { return value == out.values[0]; }))
    out.why = fmt::format("constant: {}", out.values[0]);
  return out;
}

// Returns the texts of a column, or `absent(workload)` when the table lacks the column.
template <typename Absent>
std::vector<std::string> texts(const CsvTable& table, std::string_view column,
                               const std::vector<std::string>& workloads, Absent absent) {
  std::vector<std::string> out;
  const auto found = std::ranges::find(table.columns, column);
  for (size_t i = 0; i < workloads.size(); ++i)
    out.push_back(found == table.columns.end() ? absent(workloads[i])
                                               : table.rows[i][size_t(found - table.columns.begin())]);
  return out;
}

void name_workloads(const CsvTable& table, const std::string& name, FeatureTable& out) {
  std::set<std::string> seen;
  for (const std::vector<std::string>& row : table.rows) {
    if (!seen.insert(row[0]).second)
      throw UserError({name}, fmt::format("workload '{}' is in the table twice", row[0]),
                      "every row needs a name of its own in the first column");
    out.workloads.push_back(row[0]);
  }
  out.scenes = texts(table, "scene", out.workloads,
                     [](const std::string& text) { return text.substr(0, text.rfind('_')); });
  out.shaders = texts(table, "shader", out.workloads, [](const std::string& text) {
    return text.find('_') == std::string::npos ? std::string() : text.substr(text.rfind('_') + 1);
  });
}

}  // namespace

FeatureTable feature_table(const std::string& csv, const std::string& name) {
  const CsvTable table = read_csv(csv, name);
  FeatureTable out;
  name_workloads(table, name, out);
  if (Eigen::Index(table.rows.size()) < kFewestWorkloads)
    throw UserError(
        {name},
        fmt::format("the table has {} workloads, expected at least {}", table.rows.size(), kFewestWorkloads),
        "`glint bench` runs several and writes their metrics.csv");
  std::vector<std::vector<double>> kept;
  for (size_t i = 1; i < table.columns.size(); ++i) {
    const std::string& column = table.columns[i];
    if (std::ranges::find(kIdentity, column) != std::end(kIdentity)) continue;
    Column read = read_column(table, i);
    if (column == kHostSpeed) read.why = "the host's speed, not the workload's";
    if (const auto same = std::ranges::find(kept, read.values); read.why.empty() && same != kept.end())
      read.why = fmt::format("equal to {}", out.metrics[size_t(same - kept.begin())]);
    if (!read.why.empty()) {
      out.dropped.push_back({column, read.why});
      continue;
    }
    out.metrics.push_back(column);
    kept.push_back(std::move(read.values));
  }
  if (Eigen::Index(kept.size()) < kFewestMetrics)
    throw UserError({name}, fmt::format("the table has {} columns of numbers that vary, expected at least {}",
                                        kept.size(), kFewestMetrics));
  out.values.resize(Eigen::Index(table.rows.size()), Eigen::Index(kept.size()));
  for (size_t j = 0; j < kept.size(); ++j)
    out.values.col(Eigen::Index(j)) =
        Eigen::Map<const Eigen::VectorXd>(kept[j].data(), Eigen::Index(kept[j].size()));
  out.standardised = standardised(out.values);
  return out;
}

Eigen::MatrixXd standardised(const Eigen::MatrixXd& values) {
  // The columns are scaled by powers of two, which round nothing, so that squares of the largest and the
  // smallest doubles neither overflow nor vanish.
  Eigen::MatrixXd scaled = values;
  for (auto column : scaled.colwise())
    column = column
                 .unaryExpr([exponent = std::ilogb(column.cwiseAbs().maxCoeff())](double value) {
                   return std::scalbn(value, -exponent);
                 })
                 .eval();
  const Eigen::MatrixXd centred = scaled.rowwise() - scaled.colwise().mean();
  const Eigen::RowVectorXd deviation = (centred.colwise().squaredNorm() / double(values.rows())).cwiseSqrt();
  return centred.array().rowwise() / deviation.array();
}

Eigen::VectorXd pairwise_distances(const Eigen::MatrixXd& rows) {
  const Eigen::Index n = rows.rows();
  Eigen::VectorXd out(n * (n - 1) / 2);
  for (Eigen::Index i = 0, at = 0; i < n; ++i)
    for (Eigen::Index j = i + 1; j < n; ++j) out[at++] = (rows.row(i) - rows.row(j)).norm();
  return out;
}

}  // namespace glint::report
