// Tests that every view of annotated source shows the same cycles, and that source.json reads back.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/annotate.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>

#include "base/diagnostics.h"
#include "report/page/source.h"
#include "tests/support/catch.h"

namespace glint::report {
namespace {

// Returns a listing of lines 1 and 2 of a.rgen. It has two SPIR-V instructions, of which the second became
// two; the last instruction comes from nowhere.
ProgramListing program() {
  ProgramListing out{"a.rgen", "ray_generation", {"a.rgen"}, {}, {}, {{"main", 0, 0, 0}}};
  out.spirv = {{"%main = OpFunction %void None %3", 0, 0, 0, 0},
               {"%8 = OpFAdd %float %6 %7", 0, 1, 0, 0},
               {"OpStore %9 %8", 0, 2, 0, 0}};
  out.isa = {{"add.f32 %r1, %r2, %r3;", 0, 1, 2, 1},
             {"mov.b32 %r4, %r1;", 0, 2, 3, 1},
             {"st.global.b32 [%rd6], %r4;", 0, 2, 3, 1},
             {"exit;", 0, 0, 0, 0}};
  return out;
}

std::optional<std::string> text_of(const std::string& path) {
  if (path != "a.rgen") return std::nullopt;
  return "float x = a + b;\n\tout_x = x;\r\n}\n";
}

ProfileTable profile() {
  ProfileTable out;
  out.reasons = {"issued", "long_scoreboard"};
  const uint64_t waits[] = {0, 10, 70, 10};
  for (uint32_t i = 0; i < 4; ++i) {
    const ListedLine line = program().isa[i];
    ProfileRow& row = out.rows.emplace_back();
    row.shader = "a.rgen", row.stage = "ray_generation", row.file = line.line ? "a.rgen" : "",
    row.line = line.line, row.spirv = line.spirv, row.index = i;
    row.issues = 2, row.lanes = 32, row.sectors = i == 2 ? 8 : 0, row.slots = {2, waits[i]};
  }
  ProfileRow& nowhere = out.rows.emplace_back();
  nowhere.slots = {0, 500};
  return out;
}

SourceMap map() {
  return source_map({program()}, text_of);
}

// Adds up the shares at the beginning of lines that have them, without the heading's.
double shares(const std::string& text) {
  double sum = 0;
  const std::regex share("\\n *([0-9.]+) %");
  for (std::sregex_iterator at(text.begin(), text.end(), share), end; at != end; ++at)
    sum += std::stod((*at)[1]);
  return sum;
}

}  // namespace

TEST_CASE("annotated SPIR-V and ISA have all cycles of instructions, GLSL those of known lines") {
  const ProfileTable profiled = profile();
  const SourceMap source = map();
  const Annotator annotator(profiled, source, kUsualMeasures, {});
  CHECK(shares(annotator.isa(0)) == Approx(100).margin(0.2));
  CHECK(shares(annotator.spirv(0)) == Approx(100).margin(0.2));
  CHECK(shares(annotator.file(source.files[0])) == Approx(87.8).margin(0.2));  // 86 of 98
  CHECK(annotator.file(source.files[0]).find("a.rgen: 87.8 %") == 0);
  CHECK(annotator.isa(0).find("73.5 %       2   16.0        8  long_scoreboard 97.2 %      2  st.global.b32 "
                              "[%rd6], %r4;       3  a.rgen:2") != std::string::npos);
  CHECK(annotator.spirv(0).find("(of no SPIR-V instruction)") != std::string::npos);
}

TEST_CASE("the view of everything has the SPIR-V below its line and the ISA below that") {
  const ProfileTable profiled = profile();
  const SourceMap source = map();
  const std::string text = Annotator(profiled, source, {"issues", "long_scoreboard"}, {}).all(0);
  const size_t line = text.find("     4               80       2      out_x = x;"),
               spirv = text.find("OpStore"), isa = text.find("st.global");
  CHECK(text.find("issues  long_scoreboard  number") != std::string::npos);
  CHECK(line < spirv);
  CHECK(spirv < isa);
  CHECK(isa != std::string::npos);
  CHECK(text.find("exit;") == std::string::npos);  // this instruction has no line
}

TEST_CASE(
    "a program that comes from no SPIR-V has its ISA below its lines, and says so where SPIR-V is asked "
    "for") {
  ProgramListing kernel = program();
  kernel.spirv.clear();
  for (ListedLine& line : kernel.isa) line.spirv = 0;
  const ProfileTable profiled = profile();
  const SourceMap source = source_map({kernel}, text_of);
  const Annotator annotator(profiled, source, {"issues"}, {});
  CHECK(annotator.all(0).find("out_x = x;\n     2       1          mov.b32 %r4, %r1;") != std::string::npos);
  CHECK(annotator.spirv(0).find("not compiled from SPIR-V") != std::string::npos);
}

TEST_CASE("the costliest lines and instructions come first, however the source orders them") {
  const ProfileTable profiled = profile();
  const SourceMap source = map();
  const Annotator annotator(profiled, source, {"cycles"}, {});
  const auto everything = [](const auto&) { return true; };
  CHECK(annotator.top_lines(1, everything, false) ==
        "The 1 of 2 lines that cost most: 85.7 % of the cycles of all instructions\n"
        "cycles     place  source\n"
        "85.7 %  a.rgen:2      out_x = x;\n\n");
  CHECK(annotator.top_lines(5, everything, false).find("The 2 of 2 lines") == 0);
  CHECK(annotator.top_lines(1, everything, true).find("OpStore %9 %8\n") != std::string::npos);
  CHECK(annotator
            .top_lines(
                1, [](const std::string&) { return false; }, false)
            .find("The 0 of 0") == 0);
  const std::string isa = annotator.top_instructions(2, everything, false);
  CHECK(isa.find("73.5 %  a.rgen      2  st.global.b32 [%rd6], %r4;  a.rgen:2\n"
                 "12.2 %  a.rgen      1  mov.b32 %r4, %r1;           a.rgen:2\n") != std::string::npos);
  CHECK(annotator.top_instructions(3, everything, true).find("12.2 %  a.rgen       0  (of no SPIR-V") !=
        std::string::npos);
}

TEST_CASE("a file whose text is not known shows the lines with figures, and no others") {
  const ProfileTable profiled = profile();
  const SourceMap source = source_map({program()}, [](const std::string&) { return std::nullopt; });
  const std::string text = Annotator(profiled, source, kUsualMeasures, {}).file(source.files[0]);
  // The lines are the heading, the columns, two lines and an empty one.
  CHECK(std::count(text.begin(), text.end(), '\n') == 5);
}

TEST_CASE(
    "heat is coloured on terminals that can, and a measure that does not exist is refused with those that "
    "do") {
  const ProfileTable profiled = profile();
  const SourceMap source = map();
  CHECK(Annotator(profiled, source, kUsualMeasures, {}).isa(0).find('\x1b') == std::string::npos);
  CHECK(Annotator(profiled, source, kUsualMeasures, {.utf8 = true, .colour = true})
            .isa(0)
            .find("\x1b[1;31m73.5 %") != std::string::npos);
  CHECK_THROWS_WITH(Annotator(profiled, source, {"heat"}, {}),
                    Catch::Contains("'heat'") && Catch::Contains("long_scoreboard"));
}

TEST_CASE(
    "a source document that is written and read again says the same, texts that are not known included") {
  ProgramListing two = program();
  two.files = {"gone.glsl", "a.rgen"};
  for (ListedLine& line : two.isa) line.file = line.line == 2 ? 1 : 0;
  const SourceMap written = source_map({program(), two}, text_of);
  const SourceMap read = parse_source(source_json(written), "source.json");
  CHECK(source_json(read) == source_json(written));
  REQUIRE(read.files.size() == 2);
  CHECK(read.files[0].lines == std::vector<std::string>{"float x = a + b;", "    out_x = x;", "}"});
  CHECK(!read.files[1].is_known);
  CHECK(read.programs[1].isa[0].file == 1);  // gone.glsl
  CHECK(read.programs[1].isa[1].file == 0);
}

TEST_CASE("a source document that is cut, of another version, or names what is not there is refused") {
  const std::string good = source_json(map());
  CHECK_THROWS_WITH(parse_source(good.substr(0, good.size() / 2), "s.json"), Catch::Contains("s.json"));
  CHECK_THROWS_WITH(parse_source("{\"schema\": 99}", "s.json"), Catch::Contains("schema 1"));
  CHECK_THROWS_WITH(parse_source("{\"schema\": 1}", "s.json"), Catch::Contains("incomplete"));
  SourceMap wrong = map();
  wrong.programs[0].isa[0].spirv = 4;
  CHECK_THROWS_WITH(parse_source(source_json(wrong), "s.json"), Catch::Contains("names what is not there"));
}

TEST_CASE("a profile and a source document of two runs make no page") {
  ProfileTable other = profile();
  other.rows[1].index = 4;
  CHECK_THROWS_AS(page_source(other, map()), UserError);
  CHECK(page_source(profile(), map())["counts"].size() > 0);
}

}  // namespace glint::report
