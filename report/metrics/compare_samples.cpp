// Compares the estimates of two sampled runs, pair by pair where they have timed the same.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/compare_samples.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <initializer_list>
#include <map>
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
constexpr const char* kFile = "sample.csv";

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

// Holds what was timed: batches of blocks, or launches of clusters.
struct Timed {
  CsvTable table;
  Column launches, clusters, weights;  // empty for batches

  explicit Timed(const std::string& csv) : table(read_csv(csv, kFile)) {
    if (std::ranges::find(table.columns, "cluster") == table.columns.end()) return;
    launches = column("launch"), clusters = column("cluster"), weights = column("weight");
  }
  Column column(const std::string& name) const { return column_of(table, name, kFile); }
  size_t size() const { return table.rows.size(); }
  bool has_launches() const { return !clusters.empty(); }
  // Returns the sum over all batches, or over all launches that the timed ones stand for.
  double sum(const Column& column) const {
    double out = 0;
    for (size_t i = 0; i < column.size(); ++i) out += has_launches() ? weights[i] * column[i] : column[i];
    return out;
  }
};

// Returns what each batch or launch adds to the error of the quotient of the columns' sums.
Column influences(const Timed& timed, const Column& above, const Column& below) {
  const double whole = timed.sum(below), quotient = timed.sum(above) / whole;
  Column out;
  for (size_t i = 0; i < above.size(); ++i) out.push_back((above[i] - quotient * below[i]) / whole);
  return out;
}

std::optional<double> estimate_of(const RunRecord& run, const std::string& name) {
  const std::vector<double> values = run.values("gpu.sample." + name);
  return values.size() == 1 ? std::optional(values[0]) : std::nullopt;
}

// Returns the half of a 95 % interval of the sum of what batches add, which is 0.
double half_of_batches(const Column& added) {
  double squares = 0;
  for (const double one : added) squares += one * one;
  const auto n = double(added.size());
  return student_quantile(uint32_t(added.size()) - 1) * std::sqrt(n / (n - 1) * squares);
}

// Does the same for launches, of which those of a cluster scatter around their mean.
double half_of_launches(const Timed& timed, const Column& added) {
  struct Cluster {
    double launches = 0, size = 0, sum = 0, squares = 0;
  };
  std::map<double, Cluster> clusters;
  for (size_t i = 0; i < added.size(); ++i) {
    Cluster& cluster = clusters[timed.clusters[i]];
    ++cluster.launches, cluster.size += timed.weights[i];
    cluster.sum += added[i], cluster.squares += added[i] * added[i];
  }
  double variance = 0;
  for (const auto& [number, cluster] : clusters) {
    const double n = cluster.launches;
    if (n > 1)
      variance += cluster.size * (cluster.size - n) / n *
                  std::max(0.0, cluster.squares - cluster.sum * cluster.sum / n) / (n - 1);
  }
  return student_quantile(uint32_t(added.size() - clusters.size())) * std::sqrt(variance);
}

// Returns half the interval of the difference of the quotients, pair by pair.
std::optional<double> paired_half(const Compared& which, const Timed& before, const Timed& after) {
  if (before.size() != after.size() || before.size() < 2) return std::nullopt;
  // A sum over launches is divided by nothing. Frames without rays have no nodes; their work is instructions.
  const bool is_sum = before.has_launches() && std::string(which.below) == "nodes",
             no_rays = before.sum(before.column("nodes")) == 0;
  const auto of = [&](const Timed& timed, const char* name) {
    if (is_sum && std::string(name) == "nodes") return Column(timed.size(), 1.0);
    return timed.column(no_rays && std::string(name) == "nodes" ? "instructions" : name);
  };
  const Column y1 = of(before, which.above), x1 = of(before, which.below), y2 = of(after, which.above),
               x2 = of(after, which.below);
  if (before.sum(x1) <= 0 || after.sum(x2) <= 0) return std::nullopt;
  const double q1 = which.is_relative ? before.sum(y1) / before.sum(x1) : 1,
               q2 = which.is_relative ? after.sum(y2) / after.sum(x2) : 1;
  const Column a = influences(before, y1, x1), b = influences(after, y2, x2);
  Column added;
  for (size_t i = 0; i < a.size(); ++i) added.push_back(b[i] / q2 - a[i] / q1);
  return before.has_launches() ? half_of_launches(before, added) : half_of_batches(added);
}

double half_of(const RunRecord& run, const std::string& name) {
  return (estimate_of(run, name + "_high").value_or(0) - estimate_of(run, name + "_low").value_or(0)) / 2;
}

}  // namespace

bool is_sampled(const RunRecord& run) {
  return run.fact("sample.share").has_value();
}

namespace {

// Returns whether the runs have timed the same blocks or launches.
bool is_paired(const RunRecord& before, const RunRecord& after, const Timed& was, const Timed& is) {
  return std::ranges::all_of(
             std::initializer_list<const char*>{"share", "seed", "scale", "blocks", "launches", "timed"},
             [&](const char* name) {
               const std::string fact = fmt::format("sample.{}", name);
               return before.fact(fact) == after.fact(fact);
             }) &&
         before.text("sample.by") == after.text("sample.by") && was.launches == is.launches &&
         was.clusters == is.clusters && was.weights == is.weights;
}

}  // namespace

SampleComparison compare_samples(const RunRecord& before, const RunRecord& after,
                                 const std::string& csv_before, const std::string& csv_after) {
  const Timed was(csv_before), is(csv_after);
  SampleComparison out;
  out.is_paired = is_paired(before, after, was, is);
  out.of_launches = was.has_launches();
  for (const Compared& which : kCompared) {
    const auto a = estimate_of(before, which.name), b = estimate_of(after, which.name);
    if (!a || !b || (which.is_relative && *a == 0)) continue;
    SampleChange change{which.name, *a, *b, which.is_relative};
    change.change = which.is_relative ? *b / *a - 1 : *b - *a;
    double half = std::hypot(half_of(before, which.name), half_of(after, which.name));
    if (which.is_relative) half /= *a;
    if (const auto paired = out.is_paired ? paired_half(which, was, is) : std::nullopt)
      half = which.is_relative ? *paired * *b / *a : *paired;
    change.low = change.change - half, change.high = change.change + half;
    out.changes.push_back(change);
  }
  return out;
}

std::string how_compared(const SampleComparison& comparison) {
  const std::string what = comparison.of_launches ? "launches" : "blocks";
  return comparison.is_paired
             ? fmt::format("Both runs have timed the same {}, so the changes are those of pairs of {}.", what,
                           comparison.of_launches ? what : "batches")
             : fmt::format("The runs have timed different {}, so the changes have the intervals of both.",
                           what);
}

std::string comparison_text(const SampleComparison& comparison) {
  std::vector<std::vector<std::string>> rows{{"estimate", "A", "B", "change", "95 % interval", ""}};
  for (const SampleChange& c : comparison.changes) {
    const auto text = [&](double x) {
      return c.is_relative ? fmt::format("{:+.2f} %", 100 * x) : fmt::format("{:+.4f}", x);
    };
    rows.push_back({c.name, fmt::format("{:.6g}", c.before), fmt::format("{:.6g}", c.after), text(c.change),
                    fmt::format("{} to {}", text(c.low), text(c.high)),
                    c.is_significant() ? "significant" : "not significant"});
  }
  return table(rows, "<>>><<") + how_compared(comparison) + "\n";
}

}  // namespace glint::report
