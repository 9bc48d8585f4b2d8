// Flattens a tree of statistics.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/stat_rows.h"

#include <algorithm>
#include <cstddef>
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
  // Returns the path of the group that is being visited, with a dot at its end.
  std::string_view prefix() const { return prefix_; }
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
  explicit SumVisitor(std::string_view pattern) : pattern_(pattern) {}
  std::optional<double> sum;

  // A star does not cross a dot, so nothing matches in a group whose path is unlike the pattern's beginning.
  void enter(const stats::Group& group) override {
    if (unlike_ == 0) {
      PathVisitor::enter(group);
      if (path_matches(beginning_of(pattern_, parts_of(prefix())), prefix())) return;
    }
    ++unlike_;
  }
  void leave(const stats::Group& group) override {
    if (unlike_ > 0) --unlike_;
    if (unlike_ == 0) PathVisitor::leave(group);
  }

  void visit(const stats::Counter& stat) override { add(stat, double(stat.value())); }
  void visit(const stats::Ratio& stat) override { add(stat, stat.value()); }
  void visit(const stats::Value& stat) override { add(stat, stat.value()); }
  void visit(const stats::Histogram&) override {}
  void visit(const stats::BreakdownBase& stat) override {
    if (unlike_ > 0) return;
    for (const auto& [name, count] : stat.parts()) add(stat, double(count), "::" + std::string(name));
  }

 private:
  static ptrdiff_t parts_of(std::string_view prefix) { return std::count(prefix.begin(), prefix.end(), '.'); }
  // Returns the pattern up to its n-th dot.
  static std::string_view beginning_of(std::string_view pattern, ptrdiff_t n) {
    size_t end = 0;
    for (; n > 0; --n) {
      const size_t dot = pattern.find('.', end);
      if (dot == std::string_view::npos) return pattern;
      end = dot + 1;
    }
    return pattern.substr(0, end);
  }
  void add(const stats::Stat& stat, double value, const std::string& part = {}) {
    if (unlike_ == 0 && path_matches(pattern_, path_of(stat) + part)) sum = sum.value_or(0.0) + value;
  }
  std::string_view pattern_;
  size_t unlike_ = 0;  // groups around the place that is visited that cannot match
};

}  // namespace

// Where a star has taken too little, only the last one can take more: what an earlier one took is the least
// that reaches the text between them, and a later place would leave the last one no more to choose from.
bool path_matches(std::string_view pattern, std::string_view path) {
  size_t at = 0, star = std::string_view::npos, taken = 0;  // `taken`: the end of what the last star takes
  for (size_t i = 0; i < path.size();) {
    if (at < pattern.size() && pattern[at] == '*') {
      star = at++;
      taken = i;
    } else if (at < pattern.size() && pattern[at] == path[i]) {
      ++at, ++i;
    } else if (star != std::string_view::npos && path[taken] != '.') {
      at = star + 1;
      i = ++taken;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', at) == std::string_view::npos;
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
