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
    prefix_.append(group.name()).append(".");
  }
  void leave(const stats::Group&) override {
    prefix_.resize(lengths_.back());
    lengths_.pop_back();
  }

 protected:
  // Returns the path of a statistic, or that of one of its parts.
  std::string path_of(const stats::Stat& stat, std::string_view part = {}) const {
    std::string path;
    path.reserve(prefix_.size() + stat.name().size() + part.size() + 2);
    path.append(prefix_).append(stat.name());
    if (!part.empty()) path.append("::").append(part);
    return path;
  }

 private:
  std::string prefix_;
  std::vector<size_t> lengths_;
};

// Returns the number in decimal. Most statistics are counts, and this is the cheapest way to write one.
std::string decimal(uint64_t value) {
  const fmt::format_int text(value);
  return {text.data(), text.size()};
}

class RowVisitor final : public PathVisitor {
 public:
  std::vector<StatRow> rows;

  void visit(const stats::Counter& stat) override { add(stat, "", decimal(stat.value())); }
  void visit(const stats::Ratio& stat) override { add(stat, "", fmt::format("{}", stat.value())); }
  void visit(const stats::Value& stat) override { add(stat, "", fmt::format("{}", stat.value())); }
  void visit(const stats::Histogram& stat) override {
    const stats::Bins& bins = stat.bins();
    for (size_t i = 0; i < stat.counts().size(); ++i) {
      if (stat.counts()[i] == 0) continue;  // There can be hundreds of empty bins, so these are left out.
      const uint64_t low = bins.low + i * bins.step;
      const bool last = i + 1 == stat.counts().size();
      const std::string name = last             ? fmt::format("{}+", low)
                               : bins.step == 1 ? decimal(low)
                                                : fmt::format("{}-{}", low, low + bins.step - 1);
      add(stat, name, decimal(stat.counts()[i]));
    }
  }
  void visit(const stats::BreakdownBase& stat) override {
    for (const auto& [name, count] : stat.parts()) add(stat, name, decimal(count));
  }

 private:
  void add(const stats::Stat& stat, std::string_view part, std::string value) {
    rows.push_back({path_of(stat, part), std::move(value), stat.unit(), stat.doc()});
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
  std::vector<StatName> rows;

  void visit(const stats::Counter& stat) override { add(stat); }
  void visit(const stats::Ratio& stat) override { add(stat); }
  void visit(const stats::Value& stat) override { add(stat); }
  void visit(const stats::Histogram& stat) override { add(stat); }
  void visit(const stats::BreakdownBase& stat) override { add(stat); }

 private:
  void add(const stats::Stat& stat) {
    std::string path = without_numbers(path_of(stat));
    if (seen_.insert(path).second)
      rows.push_back({std::move(path), std::string(stat.unit()), std::string(stat.doc())});
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
    for (const auto& [name, count] : stat.parts()) total(stat, name).sum += count;
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
    std::string path;
    std::string_view unit;
    uint64_t sum = 0;
    std::optional<double> largest;  // set for a computed value
  };
  Total& total(const stats::Stat& stat, std::string_view part) {
    std::string path = without_numbers(path_of(stat));
    if (!part.empty()) path.append("::").append(part);
    const auto [found, is_new] = index_.emplace(path, totals_.size());
    if (is_new) totals_.push_back({std::move(path), stat.unit(), 0, std::nullopt});
    return totals_[found->second];
  }
  void largest(const stats::Stat& stat, double value) {
    std::optional<double>& at = total(stat, "").largest;
    at = at ? std::max(*at, value) : value;
  }

  std::vector<Total> totals_;
  std::map<std::string, size_t> index_;
};

// Sums what a pattern matches. A star stands for no dot, so each group on the way takes the pattern's parts
// up to as many dots as the group's name adds to a path. Below a group that does not match, nothing is read.
class SumVisitor final : public stats::Visitor {
 public:
  explicit SumVisitor(std::string_view pattern) : rests_{pattern} {}
  std::optional<double> sum;

  void enter(const stats::Group& group) override { rests_.push_back(rest_below(group.name())); }
  void leave(const stats::Group&) override { rests_.pop_back(); }
  void visit(const stats::Counter& stat) override { add(stat); }
  void visit(const stats::Ratio& stat) override { add(stat); }
  void visit(const stats::Value& stat) override { add(stat); }
  void visit(const stats::Histogram&) override {}
  void visit(const stats::BreakdownBase& stat) override {
    if (!rests_.back() || !may_match_part(stat.name())) return;
    for (const auto& [name, count] : stat.parts())
      if (path_matches(*rests_.back(), std::string(stat.name()).append("::").append(name)))
        add(double(count));
  }

 private:
  // Returns what of the pattern is left for the paths below a group, or nothing when no path there matches.
  std::optional<std::string_view> rest_below(std::string_view name) const {
    if (!rests_.back()) return std::nullopt;
    const std::string_view pattern = *rests_.back();
    size_t dot = pattern.find('.');
    for (auto dots = std::ranges::count(name, '.'); dots > 0 && dot != std::string_view::npos; --dots)
      dot = pattern.find('.', dot + 1);
    if (dot == std::string_view::npos || !path_matches(pattern.substr(0, dot), name)) return std::nullopt;
    return pattern.substr(dot + 1);
  }
  // Tells whether the pattern's characters before its first star allow a part of the breakdown.
  bool may_match_part(std::string_view name) const {
    const std::string_view head = rests_.back()->substr(0, rests_.back()->find('*'));
    return head.size() <= name.size() ? name.starts_with(head) : head.starts_with(name);
  }
  template <class Stat>
  void add(const Stat& stat) {
    if (rests_.back() && path_matches(*rests_.back(), stat.name())) add(double(stat.value()));
  }
  void add(double value) { sum = sum.value_or(0.0) + value; }

  std::vector<std::optional<std::string_view>> rests_;  // what is left of the pattern in each open group
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

std::vector<StatName> stat_names(const stats::Group& root) {
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
