// Tests the three formats of statistics on one small tree.
// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <nlohmann/json.hpp>

#include "base/stats.h"
#include "report/files/stat_rows.h"
#include "report/files/stat_writer.h"
#include "tests/support/catch.h"

namespace glint::report {
namespace {

enum class Reason { Busy, Idle, Count };
constexpr std::string_view name_of(Reason r) {
  return r == Reason::Busy ? "busy" : "idle";
}

struct Unit : stats::Group {
  explicit Unit(stats::Group* parent) : stats::Group(parent, "l1") {}
  stats::Counter hits{this, "hits", "access", "Hits, \"good\" ones."};
  stats::Counter accesses{this, "accesses", "access", "All."};
  stats::Ratio rate{this, "rate", "fraction", hits, accesses, "Share."};
  stats::Histogram sizes{this, "sizes", "byte", stats::linear(0, 64, 32), "Sizes."};
  stats::Breakdown<Reason> cycles{this, "cycles", "cycle", "Time."};
};

struct Tree {
  stats::Group root{nullptr, "gpu"};
  Unit unit{&root};
  Tree() {
    unit.hits += 1;
    unit.accesses += 3;
    unit.sizes.add(40);
    unit.cycles.add(Reason::Idle, 9);
  }
  std::string as(const char* format) const {
    return Registry<StatWriter>::instance().entry(format).make_default({})->write(root);
  }
};

TEST_CASE("csv, json and txt are the registered formats") {
  CHECK(Registry<StatWriter>::names() == std::vector<std::string>{"csv", "json", "txt"});
}

TEST_CASE("text lines up values and says unit and meaning") {
  CHECK(Tree().as("txt") ==
        "gpu.l1.hits                           1  access    # Hits, \"good\" ones.\n"
        "gpu.l1.accesses                       3  access    # All.\n"
        "gpu.l1.rate          0.3333333333333333  fraction  # Share.\n"
        "gpu.l1.sizes::32+                     1  byte      # Sizes.\n"
        "gpu.l1.cycles::busy                   0  cycle     # Time.\n"
        "gpu.l1.cycles::idle                   9  cycle     # Time.\n");
}

TEST_CASE("csv quotes commas and doubles quotes") {
  const std::string text = Tree().as("csv");
  CHECK(text.rfind("path,value,unit,doc\ngpu.l1.hits,1,access,\"Hits, \"\"good\"\" ones.\"\n", 0) == 0);
}

TEST_CASE("json nests groups and keeps value, unit and doc of each statistic") {
  const auto json = nlohmann::json::parse(Tree().as("json"));
  const auto& unit = json.at("gpu").at("l1");

  CHECK(unit.at("hits") == nlohmann::json{{"value", 1}, {"unit", "access"}, {"doc", "Hits, \"good\" ones."}});
  CHECK(unit.at("rate").at("value") == 1.0 / 3.0);
  CHECK(unit.at("sizes").at("value") == nlohmann::json{0, 1});
  CHECK(unit.at("sizes").at("bins").at("step") == 32);
  CHECK(unit.at("cycles").at("value") == nlohmann::json{{"busy", 0}, {"idle", 9}});
}

TEST_CASE("json is laid out as nlohmann lays it out, escaped strings and empty parts too") {
  Tree tree;
  stats::Group none(&tree.root, "none");
  stats::Group odd(&tree.root, "odd \"\u00b5\"");
  stats::Value big(
      &odd, "big", "1/s", [] { return 1e300; }, "Tab:\t.");
  stats::Value undefined(
      &odd, "undefined", "", [] { return std::numeric_limits<double>::quiet_NaN(); }, "");
  const std::string text = tree.as("json");
  CHECK(text == nlohmann::ordered_json::parse(text).dump(2) + "\n");
  CHECK(text.find("\"none\": {}") != std::string::npos);
}

TEST_CASE("a sum sees groups whose names have dots, and stars in names of groups and parts") {
  Tree tree;
  stats::Group dotted(&tree.root, "part.two");
  stats::Counter count(&dotted, "n", "1", "Count.");
  count += 5;
  CHECK(stat_sum(tree.root, "gpu.part.two.n") == 5.0);
  CHECK(stat_sum(tree.root, "gpu.p*.t*.n") == 5.0);
  CHECK_FALSE(stat_sum(tree.root, "gpu.p*.n").has_value());
  CHECK(stat_sum(tree.root, "gpu.l1.cy*::*") == 9.0);
  CHECK(stat_sum(tree.root, "*.l1.*s") == 4.0);
}

TEST_CASE("names list each statistic once for all instances, empty histograms too") {
  stats::Group root(nullptr, "gpu");
  stats::Group a(&root, "core[0]"), b(&root, "core[12]");
  Unit in_a(&a), in_b(&b);
  const auto rows = stat_names(root);

  REQUIRE(rows.size() == 5);
  CHECK(rows[0].path == "gpu.core[*].l1.hits");
  CHECK(rows[3].path == "gpu.core[*].l1.sizes");
  CHECK(rows[3].unit == "byte");
}

TEST_CASE(
    "a sum takes every path that the pattern matches, parts of breakdowns too, and is absent without any") {
  Tree tree;
  stats::Group other(&tree.root, "l1b");
  stats::Counter more(&other, "accesses", "access", "More.");
  more += 10;

  CHECK(stat_sum(tree.root, "gpu.l1.accesses") == 3.0);
  CHECK(stat_sum(tree.root, "gpu.l1*.accesses") == 13.0);
  CHECK(stat_sum(tree.root, "gpu.l1.cycles::idle") == 9.0);
  CHECK_FALSE(stat_sum(tree.root, "gpu.l2.accesses").has_value());
  CHECK_FALSE(stat_sum(tree.root, "gpu.*accesses").has_value());  // a star does not cross a dot
  CHECK_FALSE(stat_sum(tree.root, "gpu").has_value());
  CHECK(stat_sum(tree.root, "*.l1*.*") == stat_sum(tree.root, "gpu.l1*.*"));
}

// Says what path_matches() says, letter by letter.
bool matches_by_trial(std::string_view pattern, std::string_view path) {
  if (pattern.empty()) return path.empty();
  if (pattern[0] == '*')
    return matches_by_trial(pattern.substr(1), path) ||
           (!path.empty() && path[0] != '.' && matches_by_trial(pattern, path.substr(1)));
  return !path.empty() && pattern[0] == path[0] && matches_by_trial(pattern.substr(1), path.substr(1));
}

// Returns all texts of up to `longest` letters.
std::vector<std::string> texts_of(std::string_view letters, size_t longest) {
  std::vector<std::string> out = {""};
  for (size_t i = 0; i < out.size() && out[i].size() < longest; ++i)
    for (const char letter : letters) out.push_back(out[i] + letter);
  return out;
}

TEST_CASE("a pattern matches the paths that trying every length of each star finds") {
  size_t wrong = 0, matched = 0;
  for (const std::string& pattern : texts_of("ab.*", 5))
    for (const std::string& path : texts_of("ab.", 5)) {
      const bool expected = matches_by_trial(pattern, path);
      matched += expected;
      if (path_matches(pattern, path) == expected) continue;
      UNSCOPED_INFO(pattern + " on " + path);
      ++wrong;
    }
  CHECK(wrong == 0);
  CHECK(matched > 1'000);
}

}  // namespace
}  // namespace glint::report
