// Flattens a tree of statistics.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/stat_rows.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace glint::report {
namespace {

// Keeps the dotted path of the group that is being visited.
class PathVisitor : public stats::Visitor {
 public:
  void enter(const stats::Group& group) override {
    lengths_.push_back(prefix_.size());
    prefix_ += group.name() + ".";
  }
  void leave(const stats::Group&) override {
    prefix_.resize(lengths_.back());
    lengths_.pop_back();
  }

 protected:
  std::string path_of(const stats::Stat& stat) const { return prefix_ + std::string(stat.name()); }

 private:
  std::string prefix_;
  std::vector<size_t> lengths_;
};

class RowVisitor final : public PathVisitor {
 public:
  std::vector<StatRow> rows;

  void visit(const stats::Counter& stat) override { add(stat, "", fmt::format("{}", stat.value())); }
  void visit(const stats::Ratio& stat) override { add(stat, "", fmt::format("{}", stat.value())); }
  void visit(const stats::Value& stat) override { add(stat, "", fmt::format("{}", stat.value())); }
  void visit(const stats::Histogram& stat) override {
    const stats::Bins& bins = stat.bins();
    for (size_t i = 0; i < stat.counts().size(); ++i) {
      if (stat.counts()[i] == 0) continue;  // There can be hundreds of empty bins, so these are left out.
      const uint64_t low = bins.low + i * bins.step;
      const bool last = i + 1 == stat.counts().size();
      const std::string name = last             ? fmt::format("::{}+", low)
                               : bins.step == 1 ? fmt::format("::{}", low)
                                                : fmt::format("::{}-{}", low, low + bins.step - 1);
      add(stat, name, fmt::format("{}", stat.counts()[i]));
    }
  }
  void visit(const stats::BreakdownBase& stat) override {
    for (const auto& [name, count] : stat.parts())
      add(stat, "::" + std::string(name), fmt::format("{}", count));
  }

 private:
  void add(const stats::Stat& stat, const std::string& part, std::string value) {
    rows.push_back(
        {path_of(stat) + part, std::move(value), std::string(stat.unit()), std::string(stat.doc())});
  }
};

// Returns a path without numbers: "core[3].l1" becomes "core[*].l1".
std::string without_numbers(const std::string& path) {
  std::string out;
  for (size_t i = 0; i < path.size(); ++i) {
    out += path[i];
    if (path[i] != '[') continue;
    const size_t close = path.find(']', i);
    if (close == std::string::npos) continue;
    out += '*';
    i = close - 1;
  }
  return out;
}

class NameVisitor final : public PathVisitor {
 public:
  std::vector<StatRow> rows;

  void visit(const stats::Counter& stat) override { add(stat); }
  void visit(const stats::Ratio& stat) override { add(stat); }
  void visit(const stats::Value& stat) override { add(stat); }
  void visit(const stats::Histogram& stat) override { add(stat); }
  void visit(const stats::BreakdownBase& stat) override { add(stat); }

 private:
  void add(const stats::Stat& stat) {
    std::string path = without_numbers(path_of(stat));
    if (seen_.insert(path).second)
      rows.push_back({std::move(path), "", std::string(stat.unit()), std::string(stat.doc())});
  }
  std::set<std::string> seen_;
};

class TotalVisitor final : public PathVisitor {
 public:
  void visit(const stats::Counter& stat) override { total(stat, "").sum += stat.value(); }
  void visit(const stats::Ratio& stat) override {
    if (path_of(stat).find('[') == std::string::npos) largest(stat, stat.value());
  }
  void visit(const stats::Value& stat) override { largest(stat, stat.value()); }
  void visit(const stats::Histogram&) override {}
  void visit(const stats::BreakdownBase& stat) override {
    for (const auto& [name, count] : stat.parts()) total(stat, "::" + std::string(name)).sum += count;
  }

  std::vector<StatRow> rows() const {
    std::vector<StatRow> out;
    for (const Total& total : totals_)
      out.push_back({total.path,
                     total.largest ? fmt::format("{}", *total.largest) : fmt::format("{}", total.sum),
                     total.unit, ""});
    return out;
  }

 private:
  struct Total {
    std::string path, unit;
    uint64_t sum = 0;
    std::optional<double> largest;  // set for a computed value
  };
  Total& total(const stats::Stat& stat, const std::string& part) {
    std::string path = without_numbers(path_of(stat)) + part;
    const auto [found, is_new] = index_.emplace(path, totals_.size());
    if (is_new) totals_.push_back({std::move(path), std::string(stat.unit()), 0, std::nullopt});
    return totals_[found->second];
  }
  void largest(const stats::Stat& stat, double value) {
    std::optional<double>& at = total(stat, "").largest;
    at = at ? std::max(*at, value) : value;
  }

  std::vector<Total> totals_;
  std::map<std::string, size_t> index_;
};

class SumVisitor final : public PathVisitor {
 public:
  explicit SumVisitor(const std::string& pattern) : pattern_(pattern) {}
  std::optional<double> sum;

  void visit(const stats::Counter& stat) override { add(stat, double(stat.value())); }
  void visit(const stats::Ratio& stat) override { add(stat, stat.value()); }
  void visit(const stats::Value& stat) override { add(stat, stat.value()); }
  void visit(const stats::Histogram&) override {}
  void visit(const stats::BreakdownBase& stat) override {
    for (const auto& [name, count] : stat.parts()) add(stat, double(count), "::" + std::string(name));
  }

 private:
  void add(const stats::Stat& stat, double value, const std::string& part = {}) {
    if (path_matches(pattern_, path_of(stat) + part)) sum = sum.value_or(0.0) + value;
  }
  const std::string& pattern_;
};

}  // namespace

bool path_matches(std::string_view pattern, std::string_view path) {
  if (pattern.empty()) return path.empty();
  if (pattern[0] == '*')
    return path_matches(pattern.substr(1), path) ||
           (!path.empty() && path[0] != '.' && path_matches(pattern, path.substr(1)));
  return !path.empty() && pattern[0] == path[0] && path_matches(pattern.substr(1), path.substr(1));
}

std::vector<StatRow> stat_rows(const stats::Group& root) {
  RowVisitor visitor;
  root.accept(visitor);
  return std::move(visitor.rows);
}

std::vector<StatRow> stat_totals(const stats::Group& root) {
  TotalVisitor visitor;
  root.accept(visitor);
  return visitor.rows();
}

std::vector<StatRow> stat_names(const stats::Group& root) {
  NameVisitor visitor;
  root.accept(visitor);
  return std::move(visitor.rows);
}

std::optional<double> stat_sum(const stats::Group& root, const std::string& pattern) {
  SumVisitor visitor(pattern);
  root.accept(visitor);
  return visitor.sum;
}

}  // namespace glint::report
