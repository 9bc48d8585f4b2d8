// Flattening of a statistics tree.
// SPDX-License-Identifier: Apache-2.0
#include "report/stat_rows.h"

#include <fmt/format.h>

namespace glint::report {
namespace {

// Keeps the dotted path of the group being visited.
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
      if (stat.counts()[i] == 0) continue;  // an empty bin says nothing, and there can be hundreds
      const uint64_t low = bins.low + i * bins.step;
      const bool last = i + 1 == stat.counts().size();
      const std::string name = last             ? fmt::format("::{}+", low)
                               : bins.step == 1 ? fmt::format("::{}", low)
                                                : fmt::format("::{}-{}", low, low + bins.step - 1);
      add(stat, name, fmt::format("{}", stat.counts()[i]));
    }
  }
  void visit(const stats::BreakdownBase& stat) override {
    for (const auto& [name, count] : stat.parts()) add(stat, "::" + std::string(name), fmt::format("{}", count));
  }

 private:
  void add(const stats::Stat& stat, const std::string& part, std::string value) {
    rows.push_back({path_of(stat) + part, std::move(value), std::string(stat.unit()), std::string(stat.doc())});
  }
};

class FindVisitor final : public PathVisitor {
 public:
  FindVisitor(const std::string& wanted, double fallback) : value(fallback), wanted_(wanted) {}
  double value;

  void visit(const stats::Counter& stat) override { look(stat, double(stat.value())); }
  void visit(const stats::Ratio& stat) override { look(stat, stat.value()); }
  void visit(const stats::Value& stat) override { look(stat, stat.value()); }
  void visit(const stats::Histogram&) override {}
  void visit(const stats::BreakdownBase& stat) override {
    for (const auto& [name, count] : stat.parts()) look(stat, double(count), "::" + std::string(name));
  }

 private:
  void look(const stats::Stat& stat, double found, const std::string& part = {}) {
    if (path_of(stat) + part == wanted_) value = found;
  }
  const std::string& wanted_;
};

}  // namespace

std::vector<StatRow> stat_rows(const stats::Group& root) {
  RowVisitor visitor;
  root.accept(visitor);
  return std::move(visitor.rows);
}

double stat_value(const stats::Group& root, const std::string& path, double fallback) {
  FindVisitor visitor(path, fallback);
  root.accept(visitor);
  return visitor.value;
}

}  // namespace glint::report
