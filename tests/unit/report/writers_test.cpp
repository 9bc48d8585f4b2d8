// The three formats of statistics, from one small tree.
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "base/stats.h"
#include "report/stat_rows.h"
#include "report/stat_writer.h"
#include "tests/support/catch.h"

namespace glint::report {
namespace {

enum class Reason { Busy, Idle, Count };
constexpr std::string_view name_of(Reason r) { return r == Reason::Busy ? "busy" : "idle"; }

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

TEST_CASE("a value is found by its path, a part of a breakdown too, and a wrong path gives the fallback") {
  const Tree tree;
  CHECK(stat_value(tree.root, "gpu.l1.accesses", -1) == 3);
  CHECK(stat_value(tree.root, "gpu.l1.cycles::idle", -1) == 9);
  CHECK(stat_value(tree.root, "gpu.l2.accesses", -1) == -1);
}

}  // namespace
}  // namespace glint::report
