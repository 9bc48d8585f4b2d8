// Tests debugPrintfEXT in real shaders: what is printed and in which order on both machines, and wrong
// formats.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/diagnostics.h"
#include "isa/text.h"
#include "tests/print/shader_run.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

using Catch::Contains;

const std::string kPrintf = "#extension GL_EXT_debug_printf : require\n";

std::string printed(const std::string& text, ShaderRun run = {}) {
  std::string both[2];
  for (const bool timing : {false, true}) {
    run.timing = timing;
    both[timing] = run_text(run, kPrintf + text);
  }
  CHECK(both[0] == both[1]);
  return both[0];
}

std::string error_of(const std::string& text) {
  try {
    compile_text({}, kPrintf + text);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

std::string main_with(const std::string& statements) {
  return "layout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer W { uint w[]; };\nvoid main() "
         "{\n" +
         statements + "\n}\n";
}

TEST_CASE("every type prints: scalars, vectors, booleans, narrow and wide numbers") {
  ShaderRun run;
  run.words = {7, 0xffff'fffe};
  const std::string text =
      "#extension GL_EXT_shader_explicit_arithmetic_types : require\n" +
      main_with(
          "int i = int(w[1]); float f = float(w[0]) / 2.0; double d = double(f) / 3.0lf;\n"
          "debugPrintfEXT(\"%d %u %x %X %o|%5d|%-5d|%05d\", i, w[0], w[1], w[1], w[0], i, i, i);\n"
          "debugPrintfEXT(\"%f %e %g %a %.3f %8.2f|\", f, f, f, f, f, f);\n"
          "debugPrintfEXT(\"%v3f and %1.2v2f and %v4d and %v2x\", vec3(f, f + 1, f + 2), vec2(f), ivec4(i), "
          "uvec2(w[0], w[1]));\n"
          "debugPrintfEXT(\"%lf %.12f %v2lf\", d, d, dvec2(d, -d));\n"
          "debugPrintfEXT(\"%ld %lu %lx %ul %u|\", int64_t(i), uint64_t(w[1]) << 8, uint64_t(w[1]) << 32, "
          "uint64_t(w[1]) << 4, uint64_t(1) << 40);\n"
          "debugPrintfEXT(\"%d %u %d %u %f\", int8_t(i), uint8_t(w[1]), int16_t(i), uint16_t(w[1]), "
          "float16_t(f));\n"
          "debugPrintfEXT(\"%d %d 100%%\", f > 1.0, f > 100.0);\n"
          "debugPrintfEXT(\"nothing\\n\");");
  CHECK(printed(text, run) ==
        "-2 7 fffffffe FFFFFFFE 7|   -2|-2   |-0002\n"
        "3.500000 3.500000e+00 3.5 0x1.cp+1 3.500     3.50|\n"
        "3.500000, 4.500000, 5.500000 and 3.50, 3.50 and -2, -2, -2, -2 and 7, fffffffe\n"
        "1.166667 1.166666666667 1.166667, -1.166667\n"
        "-2 1099511627264 fffffffe00000000 68719476704 1099511627776|\n"
        "-2 254 -2 65534 3.500000\n"
        "1 0 100%\n"
        "nothing\n");
}

TEST_CASE(
    "lines are ordered by launch id and then by program order, in divergent code and loops, at any register "
    "limit") {
  const std::string text =
      "layout(local_size_x = 24, local_size_y = 2) in;\n"
      "void main() {\n"
      "  uint id = gl_GlobalInvocationID.y * 72 + gl_GlobalInvocationID.x;\n"
      "  for (uint i = 0; i < id % 3; ++i) {\n"
      "    if ((id & 1) == 0) debugPrintfEXT(\"even %u turn %u\", id, i);\n"
      "    else debugPrintfEXT(\"odd %u turn %u of %u: %v3f\", id, i, id % 3, vec3(id, i, 0.5));\n"
      "  }\n"
      "  if (id == 100) return;\n"
      "  debugPrintfEXT(\"end %u\", id);\n"
      "}\n";
  std::string wanted;
  for (uint32_t id = 0; id < 72 * 4; ++id) {
    for (uint32_t i = 0; i < id % 3; ++i)
      wanted += id % 2 == 0 ? fmt::format("even {} turn {}\n", id, i)
                            : fmt::format("odd {} turn {} of {}: {:.6f}, {:.6f}, 0.500000\n", id, i, id % 3,
                                          double(id), double(i));
    if (id != 100) wanted += fmt::format("end {}\n", id);
  }
  for (const uint32_t registers : {16u, 24u, 64u}) {
    ShaderRun run;
    run.size = {3, 2, 1};
    run.backend.max_registers = registers;
    CHECK(printed(text, run) == wanted);
  }
}

TEST_CASE("no more lines than the limit are shown, the first by launch id, and the rest is counted") {
  const std::string text =
      "layout(local_size_x = 64) in;\nvoid main() { debugPrintfEXT(\"%u\", gl_GlobalInvocationID.x); }\n";
  ShaderRun run;
  run.size = {4, 1, 1};
  run.print_limit = 3;
  CHECK(printed(text, run) == "0\n1\n2\n(253 more messages not shown; the limit is 3)\n");
}

TEST_CASE("a ray generation shader prints by its launch id") {
  ShaderRun run;
  run.stage = isa::Stage::RayGeneration;
  run.size = {2, 3, 2};
  std::string wanted;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 2; ++x) wanted += fmt::format("{}, {}, {}\n", x, y, z);
  CHECK(printed("#extension GL_EXT_ray_tracing : require\nvoid main() { debugPrintfEXT(\"%v3u\", "
                "gl_LaunchIDEXT); }\n",
                run) == wanted);
}

TEST_CASE("prints in functions do not keep them from being inlined, and results stay what they are") {
  ShaderRun run;
  run.words = {5, 0};
  const std::string text =
      "struct Pair { uint a, b; };\nPair twice(Pair p) { Pair q = p; q.a *= 2; debugPrintfEXT(\"a %d\", "
      "q.a); return q; }\n" +
      main_with("w[1] = twice(twice(Pair(w[0], 1))).a;");
  const isa::Program program = compile_text({}, kPrintf + text);
  CHECK(program.local_bytes == 0);
  CHECK(run_text(run, kPrintf + text) == "a 10\na 20\n");
  CHECK(run.words[1] == 20);
}

TEST_CASE("a program with messages goes through its text, quotes and line ends included") {
  ShaderRun run;
  run.words = {3};
  const isa::Program program = compile_text(
      run,
      kPrintf +
          main_with("debugPrintfEXT(\"say \\\"%u\\\"\\nback\\\\slash %u %u %u %u\", w[0], 1, 2, 3, 4);"));
  CHECK(program.messages.size() == 2);
  const isa::Program again = isa::parse(isa::to_text(program), "again");
  CHECK(again == program);
  CHECK(run_program(run, again) == "say \"3\"\nback\\slash 1 2 3 4\n");
}

TEST_CASE("an argument of another kind or size than its format prints as what it is") {
  ShaderRun run;
  run.words = {7};
  CHECK(run_text(
            run,
            kPrintf + main_with("debugPrintfEXT(\"%f %d %5.1d\", w[0], float(w[0]) / 2, int(w[0]) - 9);")) ==
        "7 3.500000    -2\n");
  CHECK(run_text(run, kPrintf + main_with("debugPrintfEXT(\"%d; %v3f\", uvec2(w[0], 1), vec2(w[0]));")) ==
        "7, 1; 7.000000, 7.000000\n");
}

TEST_CASE("formats that do not fit are errors with file and line") {
  const auto error = [](const std::string& statement) { return error_of(main_with(statement)); };
  CHECK_THAT(error("debugPrintfEXT(\"%d\");"), Contains("text.comp:6") && Contains("'%d' has no argument"));
  CHECK_THAT(error("debugPrintfEXT(\"%d\", w[0], w[1]);"), Contains("takes 1 arguments, the call gives 2"));
  CHECK_THAT(error("debugPrintfEXT(\"%q\", w[0]);"), Contains("'%q' is not a conversion"));
  CHECK_THAT(error("debugPrintfEXT(\"%s\", w[0]);"), Contains("'%s' is not a conversion"));
  CHECK_THAT(error("debugPrintfEXT(\"50%\");"), Contains("is not a conversion"));
  CHECK_THAT(error("debugPrintfEXT(\"%v5f\", vec2(w[0]));"), Contains("2 to 4 components"));
  CHECK_THAT(error("debugPrintfEXT(\"%5000d\", w[0]);"), Contains("more than 999 characters"));
}

}  // namespace
}  // namespace glint::test
