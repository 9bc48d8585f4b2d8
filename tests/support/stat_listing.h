// Lists all statistics of a machine as text, and finds where two listings differ.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <fmt/format.h>
#include <sstream>
#include <string>

#include "base/stats.h"

namespace glint::test {

// Lists all numbers of a tree, one per line. Two runs are equal when their listings are.
class Listing final : public stats::Visitor {
 public:
  void enter(const stats::Group& group) override { text += group.name() + "{"; }
  void leave(const stats::Group&) override { text += "}\n"; }
  void visit(const stats::Counter& stat) override {
    text += fmt::format("{}={}\n", stat.name(), stat.value());
  }
  void visit(const stats::Ratio& stat) override { text += fmt::format("{}={}\n", stat.name(), stat.value()); }
  void visit(const stats::Value& stat) override { text += fmt::format("{}={}\n", stat.name(), stat.value()); }
  void visit(const stats::Histogram& stat) override {
    text += fmt::format("{}={}\n", stat.name(), fmt::join(stat.counts(), ","));
  }
  void visit(const stats::BreakdownBase& stat) override {
    for (const auto& [name, count] : stat.parts())
      text += fmt::format("{}::{}={}\n", stat.name(), name, count);
  }
  std::string text;
};

// Returns the first line in which two listings differ, or "".
inline std::string first_difference(const std::string& a, const std::string& b) {
  std::istringstream lines_a(a), lines_b(b);
  for (std::string line_a, line_b, group; std::getline(lines_a, line_a) && std::getline(lines_b, line_b);) {
    if (line_a.find('{') != std::string::npos) group = line_a.substr(0, line_a.find_last_of('{'));
    if (line_a != line_b) return fmt::format("in {}: {} against {}", group, line_a, line_b);
  }
  return a == b ? "" : "one is longer";
}

inline std::string listing(const stats::Group& root) {
  Listing listing;
  root.accept(listing);
  return listing.text;
}

// Returns the first counter of this name in a listing, or 0.
inline uint64_t counter_in(const std::string& listed, const std::string& name) {
  for (size_t at = 0; (at = listed.find(name + "=", at)) != std::string::npos; ++at)
    if (at == 0 || listed[at - 1] == '\n' || listed[at - 1] == '{')
      return std::stoull(listed.substr(at + name.size() + 1));
  return 0;
}

}  // namespace glint::test
