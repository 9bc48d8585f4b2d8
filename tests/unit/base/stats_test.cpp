// Tests statistics: registration, bins, ratios and the order of a visit.
// SPDX-License-Identifier: Apache-2.0
#include "base/stats.h"

#include "tests/support/catch.h"

namespace glint::stats {
namespace {

enum class Reason { Busy, Idle, Count };
constexpr std::string_view name_of(Reason r) {
  return r == Reason::Busy ? "busy" : "idle";
}

struct Unit : Group {
  Unit(Group* parent, std::string name) : Group(parent, std::move(name)) {}
  Counter hits{this, "hits", "access", "Hits."};
  Counter accesses{this, "accesses", "access", "Accesses."};
  Ratio rate{this, "rate", "fraction", hits, accesses, "Hits of accesses."};
  Histogram sizes{this, "sizes", "byte", linear(10, 40, 10), "Sizes."};
  Breakdown<Reason> cycles{this, "cycles", "cycle", "Where the time went."};
};

class Recorder final : public Visitor {
 public:
  std::string text;
  void enter(const Group& group) override { text += "<" + group.name(); }
  void leave(const Group&) override { text += ">"; }
  void visit(const Counter& stat) override { add(stat); }
  void visit(const Ratio& stat) override { add(stat); }
  void visit(const Value& stat) override { add(stat); }
  void visit(const Histogram& stat) override { add(stat); }
  void visit(const BreakdownBase& stat) override { add(stat); }

 private:
  void add(const Stat& stat) { text += " " + std::string(stat.name()); }
};

TEST_CASE("a visit goes depth first in order of declaration") {
  Group root(nullptr, "gpu");
  Unit a(&root, "a");
  Group b(&root, "b");
  Value peak(
      &b, "peak", "", [] { return 7.0; }, "");
  Recorder recorder;
  root.accept(recorder);

  CHECK(recorder.text == "<gpu<a hits accesses rate sizes cycles><b peak>>");
}

TEST_CASE("a ratio follows its counters and is 0 without a denominator") {
  Unit unit(nullptr, "u");
  CHECK(unit.rate.value() == 0.0);

  unit.hits += 3;
  unit.accesses += 4;
  CHECK(unit.rate.value() == 0.75);
  ++unit.hits;
  CHECK(unit.rate.value() == 1.0);
}

TEST_CASE("a histogram's bins are half open and its ends catch what lies outside") {
  Unit unit(nullptr, "u");
  for (const uint64_t x : {0, 10, 19, 20, 39, 40, 1000}) unit.sizes.add(x);

  CHECK(unit.sizes.counts() == std::vector<uint64_t>{3, 1, 3});
}

TEST_CASE("a breakdown's parts sum to its total and keep the order of the enum") {
  Unit unit(nullptr, "u");
  unit.cycles.add(Reason::Idle, 5);
  unit.cycles.add(Reason::Busy);

  CHECK(unit.cycles.total() == 6);
  CHECK(unit.cycles.count(Reason::Idle) == 5);
  const auto parts = unit.cycles.parts();
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].first == "busy");
  CHECK(parts[1].second == 5);
}

}  // namespace
}  // namespace glint::stats
