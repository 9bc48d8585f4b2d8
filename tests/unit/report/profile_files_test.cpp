// Tests that the files of a profile read back what was written, and that nothing is lost.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/profile_files.h"

#include <utility>

#include "base/diagnostics.h"
#include "report/files/annotate.h"
#include "tests/support/catch.h"

namespace glint::report {
namespace {

ProfileRow row(const std::string& file, uint32_t line, uint32_t index, std::vector<uint64_t> slots) {
  ProfileRow out;
  out.shader = "a.rgen", out.stage = "raygen", out.op = "ld.global.u32", out.file = file, out.line = line,
  out.index = index;
  out.issues = slots[0], out.lanes = slots[0] * 16, out.sectors = 4, out.slots = std::move(slots);
  return out;
}

// Returns a profile with two instructions of one line, one of another file, one of no line, and cycles
// without a warp.
ProfileTable sample() {
  ProfileTable out;
  out.reasons = {"issued", "long_scoreboard", "no_warp"};
  out.rows = {row("x, \"y\".glsl", 3, 0, {10, 90, 0}), row("x, \"y\".glsl", 3, 1, {10, 40, 0}),
              row("b.glsl", 1, 2, {5, 45, 0}), row("", 0, 3, {1, 0, 0})};
  ProfileRow nowhere;
  nowhere.slots = {0, 0, 99};
  out.rows.push_back(nowhere);
  return out;
}

}  // namespace

TEST_CASE("the rows of a line are its instructions added up") {
  const std::vector<ProfileRow> lines = by_line(sample());
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].file == "b.glsl");
  CHECK(lines[1].line == 3);
  CHECK(lines[1].slots == std::vector<uint64_t>{20, 130, 0});
  CHECK(lines[1].lanes == 320);
  CHECK(lines[1].sectors == 8);
}

TEST_CASE("a profile that is written and read again has the same instructions, commas and quotes included") {
  const ProfileTable again = parse_profile(profile_csv(sample()), "profile.csv");
  CHECK(again.reasons == sample().reasons);
  REQUIRE(again.rows.size() == 5);  // the rows of source lines are not read
  CHECK(again.rows[0].file == "x, \"y\".glsl");
  CHECK(again.rows[4].slots == std::vector<uint64_t>{0, 0, 99});
  CHECK(profile_csv(again) == profile_csv(sample()));
}

TEST_CASE("a file that is not a profile is refused with its place") {
  CHECK_THROWS_WITH(parse_profile("path,value\n", "p.csv"), Catch::Contains("p.csv:1"));
  std::string cut = profile_csv(sample());
  cut.resize(cut.size() - 4);
  CHECK_THROWS_WITH(parse_profile(cut, "p.csv"), Catch::Contains("p.csv:8") && Catch::Contains("columns"));
  std::string wrong = profile_csv(sample());
  wrong.replace(wrong.find(",90,"), 4, ",9o,");
  CHECK_THROWS_WITH(parse_profile(wrong, "p.csv"), Catch::Contains("p.csv:2") && Catch::Contains("9o"));
}

TEST_CASE("folded stacks have each cycle once") {
  CHECK(profile_folded(sample()) ==
        "gpu;no_warp 99\n"
        "raygen;a.rgen;issued 1\n"
        "raygen;b.glsl:1;issued 5\n"
        "raygen;b.glsl:1;long_scoreboard 45\n"
        "raygen;x, \"y\".glsl:3;issued 20\n"
        "raygen;x, \"y\".glsl:3;long_scoreboard 130\n");
}

TEST_CASE(
    "folded stacks follow the calls that the compiler kept, each chain by itself, and end where they are "
    "unknown") {
  ProfileTable profile = sample();
  profile.programs = {{"a.rgen",
                       "raygen",
                       {"a.rgen", "b.glsl"},
                       {},
                       {},
                       {{"main", 0, 0, 0}, {"shade", 1, 0, 7}, {"shade", 1, 0, 9}}}};
  profile.rows[0].scope = 2, profile.rows[1].scope = 3, profile.rows[2].scope = 1;
  const std::string folded = profile_folded(profile);
  CHECK(folded.find("raygen;main;a.rgen:7;shade;x, \"y\".glsl:3;issued 10\n") != std::string::npos);
  CHECK(folded.find("raygen;main;a.rgen:9;shade;x, \"y\".glsl:3;long_scoreboard 40\n") != std::string::npos);
  CHECK(folded.find("raygen;main;b.glsl:1;issued 5\n") != std::string::npos);
  CHECK(folded.find("raygen;a.rgen;issued 1\n") != std::string::npos);
}

TEST_CASE("files and programs come with the costliest first, and the reasons add up to all cycles") {
  const std::vector<FileShare> files = files_of(sample());
  REQUIRE(files.size() == 2);
  CHECK(files[1].file == "b.glsl");
  const std::string reasons = reason_table(sample(), {});
  CHECK(reasons.find("cycles of all schedulers: 300") == 0);
  CHECK(reasons.find("long_scoreboard") < reasons.find("no_warp"));
}

TEST_CASE("a series has its columns and a line an interval") {
  CHECK(series_csv({{"cycle", "ipc"}, {{100, 0.5}, {150, 0}}}) == "cycle,ipc\n100,0.5\n150,0\n");
}

}  // namespace glint::report
