// Tests that lines of two runs are compared with their counterparts, and that nothing is lost on the way.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/line_changes.h"

#include <optional>

#include "base/diagnostics.h"
#include "tests/support/catch.h"

namespace glint::report {
namespace {

using Pairs = std::vector<std::pair<uint32_t, uint32_t>>;

struct Run {
  ProfileTable profile;
  SourceMap map;
  operator ProfiledRun() const { return {profile, map}; }
};

// Returns a run of one file with the cycles of each line, and 7 cycles of an instruction without a line.
Run run(const std::string& path, const std::vector<std::string>& lines, const std::vector<uint64_t>& cycles) {
  Run out;
  out.profile.reasons = {"issued", "rt_wait"};
  for (uint32_t i = 0; i <= cycles.size(); ++i) {
    ProfileRow& row = out.profile.rows.emplace_back();
    row.shader = "a.rgen";
    if (i < cycles.size()) row.file = path, row.line = i + 1;
    row.issues = 1, row.slots = {1, (i < cycles.size() ? cycles[i] : 7) - 1};
  }
  out.profile.rows.emplace_back().slots = {0, 500};  // no warp
  out.map.files = {{path, true, lines}};
  return out;
}

}  // namespace

TEST_CASE("lines of an edited text are matched with themselves") {
  CHECK(matched_lines({"a", "b", "c"}, {"a", "b", "c"}) == Pairs{{1, 1}, {2, 2}, {3, 3}});
  CHECK(matched_lines({"a", "b", "c"}, {"a", "x", "b", "c"}) == Pairs{{1, 1}, {2, 3}, {3, 4}});
  CHECK(matched_lines({"a", "b", "c", "d"}, {"b", "x", "d", "e"}) == Pairs{{2, 1}, {4, 3}});
  CHECK(matched_lines({"a"}, {"b"}).empty());
  CHECK(matched_lines({}, {"b"}).empty());
}

TEST_CASE("a middle that is too large to match leaves its lines alone, and the ends matched") {
  std::vector<std::string> before(6000, "x"), after(6000, "y");
  before.front() = after.front() = "first";
  before.back() = after.back() = "last";
  CHECK(matched_lines(before, after) == Pairs{{1, 1}, {6000, 6000}});
}

TEST_CASE("a line that moved is compared with itself, and a new one with nothing") {
  const Run before = run("a.rgen", {"x = 1;", "y = 2;"}, {10, 20});
  const Run after = run("a.rgen", {"x = 1;", "z = 3;", "y = 2;"}, {10, 5, 60});
  const LineComparison comparison = compare_lines(before, after, "cycles");
  REQUIRE(comparison.lines.size() == 3);
  CHECK(comparison.lines[1].before == 0);
  CHECK(comparison.lines[1].cost_after == 5);
  CHECK(comparison.lines[2].before == 2);
  CHECK(comparison.lines[2].after == 3);
  CHECK(comparison.lines[2].cost_before == 20);
  CHECK(comparison.lines[2].cost_after == 60);
  REQUIRE(comparison.differ.size() == 1);
  CHECK(comparison.differ[0].only_before == 0);
  CHECK(comparison.differ[0].only_after == 1);
  CHECK(comparison.whole_before == 37);
  CHECK(comparison.whole_after == 82);
  CHECK(comparison.no_line_after == 7);
}

TEST_CASE("the lines that changed most come first, and those that did not change are left out") {
  const Run before = run("a.rgen", {"x = 1;", "y = 2;", "z = 3;"}, {10, 20, 100});
  const Run after = run("a.rgen", {"x = 1;", "y = 2;", "z = 3;"}, {10, 30, 40});
  const LineComparison comparison = compare_lines(before, after, "cycles");
  const std::string text = line_changes_text(comparison, "cycles", 5);
  CHECK(text.find("The 2 of 3 lines that changed most\n") == 0);
  const size_t z = text.find("        100           40     -60   0.40  a.rgen:3  z = 3;"),
               y = text.find("         20           30     +10   1.50  a.rgen:2  y = 2;");
  CHECK(z != std::string::npos);
  CHECK(y != std::string::npos);
  CHECK(z < y);
  CHECK(text.find("x = 1;") == std::string::npos);
  CHECK(line_changes_text(comparison, "cycles", 1).find("y = 2;") == std::string::npos);
  CHECK(line_changes_text(compare_lines(before, before, "cycles"), "cycles", 1)
            .find("None of the 3 lines changed") == 0);
}

TEST_CASE("a file in another folder is the same file, and a file of one run alone is named") {
  const Run before = run("one/a.rgen", {"x = 1;"}, {10}), after = run("two/a.rgen", {"x = 1;"}, {30});
  const LineComparison moved = compare_lines(before, after, "rt_wait");
  REQUIRE(moved.lines.size() == 1);
  CHECK(moved.lines[0].cost_before == 9);
  CHECK(moved.lines[0].cost_after == 29);
  CHECK(moved.differ.empty());
  const LineComparison other = compare_lines(before, run("b.rgen", {"x = 1;"}, {30}), "cycles");
  CHECK(other.files == 0);
  CHECK(other.unmatched == std::vector<std::string>{"one/a.rgen", "b.rgen"});
}

TEST_CASE("lines whose text is not known are matched by number, and the comparison says so") {
  Run before = run("a.rgen", {"x = 1;"}, {10});
  before.map.files[0].is_known = false;
  const LineComparison comparison = compare_lines(before, run("a.rgen", {"y = 1;"}, {30}), "cycles");
  REQUIRE(comparison.lines.size() == 1);
  CHECK(comparison.lines[0].cost_after == 30);
  REQUIRE(comparison.differ.size() == 1);
  CHECK_FALSE(comparison.differ[0].is_known);
}

TEST_CASE("means of lines cannot be compared") {
  const Run one = run("a.rgen", {"x = 1;"}, {10});
  CHECK_THROWS_AS(compare_lines(one, one, "latency"), UserError);
}

}  // namespace glint::report
