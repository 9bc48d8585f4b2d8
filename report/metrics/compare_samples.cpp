// Compares the estimates of two sampled runs, batch by batch where they have the same blocks.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/compare_samples.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <initializer_list>
#include <optional>

#include "base/diagnostics.h"
#include "base/student.h"
#include "report/files/csv_table.h"
#include "report/terminal/table.h"

namespace glint::report {
namespace {

// Names an estimate, and the columns of sample.csv whose quotient it follows.
struct Compared {
  const char *name, *above, *below;
  bool is_relative;
};
constexpr Compared kCompared[] = {{"cycles", "cycles", "nodes", true},
                                  {"ipc", "instructions", "cycles", true},
                                  {"l1_hit_rate", "l1_hits", "l1_reads", false},
                                  {"l2_hit_rate", "l2_hits", "l2_reads", false},
                                  {"dram_utilisation", "dram_busy", "dram_clocks", false}};

using Column = std::vector<double>;

Column column_of(const CsvTable& table, const std::string& name, const std::string& file) {
  const auto found = std::ranges::find(table.columns, name);
  if (found == table.columns.end()) throw UserError({file}, fmt::format("the file has no column '{}'", name));
  Column out;
  for (const auto& row : table.rows) {
    const std::string& text = row[size_t(found - table.columns.begin())];
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
      throw UserError({file}, fmt::format("'{}' in column '{}' is not a number", text, name));
    out.push_back(value);
  }
  return out;
}

double sum_of(const Column& column) {
  double sum = 0;
  for (const double value : column) sum += value;
  return sum;
}

// Returns what each batch adds to the error of the quotient of the columns' sums.
Column influences(const Column& above, const Column& below) {
  const double whole = sum_of(below), quotient = sum_of(above) / whole;
  Column out;
  for (size_t i = 0; i < above.size(); ++i) out.push_back((above[i] - quotient * below[i]) / whole);
  return out;
}

std::optional<double> estimate_of(const RunRecord& run, const std::string& name) {
  const std::vector<double> values = run.values("gpu.sample." + name);
  return values.size() == 1 ? std::optional(values[0]) : std::nullopt;
}

// Returns half the interval of the difference of the quotients, batch by batch.
std::optional<double> paired_half(const Compared& which, const CsvTable& before, const CsvTable& after) {
  if (before.rows.size() != after.rows.size() || before.rows.size() < 2) return std::nullopt;
  // Launches without rays have no nodes; their work is instructions.
  const bool no_rays = sum_of(column_of(before, "nodes", "sample.csv")) == 0;
  const auto of = [&](const CsvTable& table, const char* name) {
    return column_of(table, no_rays && std::string(name) == "nodes" ? "instructions" : name, "sample.csv");
  };
  const Column y1 = of(before, which.above), x1 = of(before, which.below), y2 = of(after, which.above),
               x2 = of(after, which.below);
  if (sum_of(x1) <= 0 || sum_of(x2) <= 0) return std::nullopt;
  const double q1 = which.is_relative ? sum_of(y1) / sum_of(x1) : 1,
               q2 = which.is_relative ? sum_of(y2) / sum_of(x2) : 1;
  const Column a = influences(y1, x1), b = influences(y2, x2);
  double squares = 0;
  for (size_t i = 0; i < a.size(); ++i) squares += std::pow(b[i] / q2 - a[i] / q1, 2);
  const auto n = double(a.size());
  return student_quantile(uint32_t(a.size()) - 1) * std::sqrt(n / (n - 1) * squares);
}

double half_of(const RunRecord& run, const std::string& name) {
  return (estimate_of(run, name + "_high").value_or(0) - estimate_of(run, name + "_low").value_or(0)) / 2;
}

}  // namespace

bool is_sampled(const RunRecord& run) {
  return run.fact("sample.share").has_value();
}

bool is_paired(const RunRecord& before, const RunRecord& after) {
  return std::ranges::all_of(std::initializer_list<const char*>{"share", "seed", "scale", "blocks", "timed"},
                             [&](const char* name) {
                               const std::string fact = fmt::format("sample.{}", name);
                               return before.fact(fact) == after.fact(fact);
                             });
}

std::vector<SampleChange> sample_changes(const RunRecord& before, const RunRecord& after,
                                         const std::string& csv_before, const std::string& csv_after) {
  const CsvTable was = read_csv(csv_before, "sample.csv"), is = read_csv(csv_after, "sample.csv");
  std::vector<SampleChange> out;
  for (const Compared& which : kCompared) {
    const auto a = estimate_of(before, which.name), b = estimate_of(after, which.name);
    if (!a || !b || (which.is_relative && *a == 0)) continue;
    SampleChange change{which.name, *a, *b, which.is_relative};
    change.change = which.is_relative ? *b / *a - 1 : *b - *a;
    double half = std::hypot(half_of(before, which.name), half_of(after, which.name));
    if (which.is_relative) half /= *a;
    if (const auto paired = is_paired(before, after) ? paired_half(which, was, is) : std::nullopt)
      half = which.is_relative ? *paired * *b / *a : *paired;
    change.low = change.change - half, change.high = change.change + half;
    out.push_back(change);
  }
  return out;
}

std::string sample_changes_text(const std::vector<SampleChange>& changes, bool paired) {
  std::vector<std::vector<std::string>> rows{{"estimate", "A", "B", "change", "95 % interval", ""}};
  for (const SampleChange& c : changes) {
    const auto text = [&](double x) {
      return c.is_relative ? fmt::format("{:+.2f} %", 100 * x) : fmt::format("{:+.4f}", x);
    };
    rows.push_back({c.name, fmt::format("{:.6g}", c.before), fmt::format("{:.6g}", c.after), text(c.change),
                    fmt::format("{} to {}", text(c.low), text(c.high)),
                    c.is_significant() ? "significant" : "not significant"});
  }
  return table(rows, "<>>><<") +
         (paired ? "Both runs have timed the same blocks, so the changes are those of pairs of batches.\n"
                 : "The runs have timed different blocks, so the changes have the intervals of both.\n");
}

}  // namespace glint::report
