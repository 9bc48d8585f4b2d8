// Tests shaders that are long, deep or large: each compiles, or is refused at a file and line before a tool
// takes minutes over it. Without the limits these tests end in a crash or do not end.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/limits.h"

#include <algorithm>
#include <functional>

#include "base/diagnostics.h"
#include "frontend/deep_stack.h"
#include "frontend/glsl/token_count.h"
#include "frontend/spirv/short_blocks.h"
#include "frontend/spirv/spirv.h"
#include "frontend/virtual_program.h"
#include "tests/support/catch.h"
#include "tests/unit/frontend/shader_lab.h"

namespace glint::frontend {
namespace {

using Catch::Contains;

std::string times(int n, const std::function<std::string(int)>& text) {
  std::string all;
  for (int i = 0; i < n; ++i) all += text(i);
  return all;
}
std::string times(int n, const std::string& text) {
  return times(n, [&](int) { return text; });
}

// Returns a compute shader whose main() has x = v[0]. Without `before`, the body begins in line 4.
std::string shader(const std::string& body, const std::string& before = "\n") {
  return "#version 460\nlayout(binding = 0) buffer B { float v[]; };" + before +
         "void main() { float x = v[0];\n" + body + "\nv[1] = x; }\n";
}

isa::Program compiled(const std::string& source) {
  Diagnostics warnings;
  const auto words = glsl_text_to_spirv(source, "t.comp", isa::Stage::Compute, {});
  isa::Program program = compile_module(words, "t.comp", {}, {}, warnings, nullptr).program;
  CHECK(warnings.messages().empty());
  return program;
}

long count_ops(const isa::Program& program, const char* op) {
  return std::count_if(program.code.begin(), program.code.end(),
                       [&](const isa::Inst& inst) { return inst.op == isa::op_index(op); });
}

std::string nested_macros(int levels) {
  return "\n#define A0 x +\n" + times(levels, [](int i) {
           return "#define A" + std::to_string(i + 1) + " A" + std::to_string(i) + " A" + std::to_string(i) +
                  "\n";
         });
}

// Returns functions f0 to f`last`, one a line from line 4 on, each of which calls the one before it.
std::string called_functions(int last) {
  return "\n\nfloat f0(float x) { return x * 1.5; }\n" + times(last, [](int i) {
           return "float f" + std::to_string(i + 1) + "(float x) { return f" + std::to_string(i) + "(x); }\n";
         });
}

std::string nested_loops(int depth) {
  return times(depth, "for (int i = 0; i < int(x); ++i) {\n") + "x *= 1.5;" + times(depth, "}");
}

TEST_CASE("what is too large, too deep or too long is refused at its file and line") {
  struct Row {
    std::string name, source, message;
  };
  const std::vector<Row> rows = {
      {"ifs", shader(times(1100, "if (x > 2.0) {\n") + "x += 1.0;" + times(1100, "}")),
       "t.comp:1103: selections and loops lie 1100 deep in each other, with those of called functions, and "
       "at most "
       "1023 are possible"},
      {"loops", shader(nested_loops(128)),
       "t.comp:131: loops lie 128 deep in each other, with those of called functions, and at most 127"},
      {"nesting of called functions",
       shader("x = f(x);" + times(600, "if (x > 2.0) {\n") + "x = f(x);" + times(600, "}"),
              "float f(float x) {\n" + times(500, "if (x > 2.0) {") + "\nx += 1.0;\n" + times(500, "}") +
                  "return x; }\n"),
       "1100 deep"},
      {"calls", shader("x = f1001(x);", called_functions(1001)),
       "t.comp:6: calls of functions lie 1002 deep in each other, and at most 1000 are possible"},
      {"terms", shader("x = " + times(400'000, "x + ") + "x;"), "t.comp:4: error: the shader has 800"},
      {"macros", shader("x = A25 x;", nested_macros(25)),
       "t.comp:30: error: 'A25' expands to 67108864 tokens"},
      {"macros in arguments",
       shader("x = " + times(25, "F(") + "x" + times(25, ")") + ";", "\n#define F(a) a + a\n"),
       "t.comp:5: error: 'F' expands to 67108863 tokens"},
      {"an array", shader("float a[2147483647];\na[int(x)] = x;\nx = a[int(v[2])];"),
       "t.comp:5: variable 'a' takes 8589934588 bytes of every thread, and at most 524288 are possible"},
      {"an array outside of functions",
       shader("\na[int(x)] = x;\nx = a[int(v[2])];", "\nfloat a[100000000];\n"),
       "t.comp:6: variable 'a' takes 400000000 bytes"},
      {"arrays together",
       shader("float a[70000], b[70000];\na[int(x)] = x;\nb[int(x)] = x;\nx = a[int(v[2])] + b[int(v[3])];"),
       "the variables take more than 524288 bytes"},
  };
  for (const Row& row : rows) {
    INFO(row.name);
    CHECK_THROWS_WITH(compiled(row.source), Contains(row.message) && Contains("t.comp:"));
  }
}

TEST_CASE("the largest array, the deepest nesting and long texts compile") {
  CHECK(compiled(shader("float a[131072]; a[int(x)] = x; x = a[int(v[2])];")).local_bytes == kMostLocalBytes);
  const int deepest = int(kDeepestNesting);
  CHECK(count_ops(compiled(shader(times(deepest, "if (x > 2.0) {\n") + "x *= 1.5;" + times(deepest, "}"))),
                  "mul.rn.f32") == 1);
  CHECK(count_ops(compiled(shader("x = f999(x);", called_functions(int(kDeepestCalls) - 1))), "mul.rn.f32") ==
        1);
  CHECK(count_ops(compiled(shader(nested_loops(int(kDeepestLoops)))), "mul.rn.f32") == 1);
  CHECK(count_ops(compiled(shader("x = x" + times(20'000, " + x") + ";")), "add.rn.f32") == 20'000);
  CHECK(count_ops(compiled(shader("x = A8 x;", nested_macros(8))), "add.rn.f32") == 256);
}

TEST_CASE(
    "SPIR-V that the validator would take too long to look at is refused, and that of glslang is taken") {
  const std::string deep = shader(times(300, "if (x > 2.0) {\n") + "x *= 1.5;" + times(300, "}"));
  const std::string text = disassemble_spirv(glsl_text_to_spirv(deep, "t.comp", isa::Stage::Compute, {}));
  CHECK_THROWS_WITH(assemble_spirv(text, "t.spvasm"),
                    Contains("t.comp:303: ") && Contains("at most 255 are"));
}

TEST_CASE(
    "the validator is spared modules of glslang with more than 2,500 selections, and no SPIR-V that is "
    "read") {
  for (const int selections : {2500, 2501}) {
    auto words = glsl_text_to_spirv(shader(times(selections, "if (x > 1.5) x = sqrt(x);\n")), "t.comp",
                                    isa::Stage::Compute, {});
    CHECK(selections_and_loops_of(words) == uint32_t(selections));
    words[3] = 1;  // No id is below this bound.
    CHECK_THAT(validate_spirv(words), Contains("ID"));
#ifndef GLINT_DCHECKS
    CHECK(validate_made_spirv(words).empty() == (selections > 2500));
#endif
  }
}

TEST_CASE("a chain of a thousand `else if` compiles") {
  const std::string chain =
      times(1000, [](int i) { return "if (x > " + std::to_string(2000 - i) + ".0) x *= 1.5;\nelse "; });
  CHECK(count_ops(compiled(shader(chain + "x = 0.0;")), "mul.rn.f32") == 1000);
}

TEST_CASE("thousands of calls in one block, or of functions that call each other twice, are inlined") {
  const std::string plain = "\nfloat f0(float x) { return x * 1.5 + v[2]; }\n";
  CHECK(count_ops(compiled(shader(times(3000, "x = f0(x);\n"), plain)), "mul.rn.f32") == 3000);
  const std::string doubled =
      plain + times(11, [](int i) {
        const std::string f = "f" + std::to_string(i);
        return "float f" + std::to_string(i + 1) + "(float x) { return " + f + "(" + f + "(x)); }\n";
      });
  CHECK(count_ops(compiled(shader("x = f11(x);", doubled)), "mul.rn.f32") == 2048);
}

TEST_CASE("a thousand cases of a switch and a thousand selections in a row compile") {
  const std::string cases = times(1000, [](int i) {
    return "case " + std::to_string(i) + ": x = x * 1.5 + v[" + std::to_string(i) + "]; break;\n";
  });
  CHECK(count_ops(compiled(shader("switch (int(v[1])) {" + cases + "}")), "mul.rn.f32") == 1000);
  CHECK(count_ops(compiled(shader(times(1000, "if (x > v[3]) x = sqrt(x);\n"))), "setp.gt.f32") == 1000);
}

TEST_CASE("a few members of a large array or struct are values of their own, in selections too") {
  const auto stores = [](const std::string& member) {
    return times(500, [&](int i) {
      return "if (x > " + std::to_string(i) + ".0) " + member + (member == "s.a" ? "" : "[") +
             std::to_string(i) + (member == "s.a" ? "" : "]") + " = v[" + std::to_string(i) + "];\n";
    });
  };
  const isa::Program array = compiled(shader("float a[20000];\n" + stores("a") + "x += a[7] * a[8];"));
  CHECK(array.local_bytes == 0);
  CHECK(count_ops(array, "mul.rn.f32") == 1);
  const std::string members = times(3000, [](int i) { return "float a" + std::to_string(i) + ";"; });
  const isa::Program of_struct =
      compiled(shader("S s;\n" + stores("s.a") + "x += s.a7 * s.a8;", "\nstruct S {" + members + "};\n"));
  CHECK(of_struct.local_bytes == 0);
  CHECK(count_ops(of_struct, "mul.rn.f32") == 1);
}

TEST_CASE("a table of 20,000 numbers and 3,000 functions with parameters of one name compile") {
  const std::string numbers = times(20'000, [](int i) { return ", " + std::to_string(i) + ".25"; });
  const isa::Program program =
      compiled(shader("x = t[int(x)];", "\nconst float t[20001] = float[](0.25" + numbers + ");\n"));
  CHECK(program.constants.size() >= 20'001);
  const std::string functions =
      times(3000, [](int i) { return "float f" + std::to_string(i) + "(float x) { return x * 1.5; }\n"; });
  const std::string calls = times(3000, [](int i) { return "x = f" + std::to_string(i) + "(x);\n"; });
  CHECK(count_ops(compiled(shader(calls, "\n" + functions)), "mul.rn.f32") == 3000);
}

TEST_CASE("a block with many calls is cut, and phis name the part that a value now comes from") {
  const std::string before = "\nfloat f(float x) { if (x > 2.0) return x; return x * 1.5; }\n";
  const auto words = glsl_text_to_spirv(
      shader(times(5, "x = f(x);\n") + "x = f(x) > 1.0 && f(x + 1.0) > 2.0 ? 1.0 : 0.0;", before), "t.comp",
      isa::Stage::Compute, {});
  const auto labels = [](const std::vector<uint32_t>& w) {
    int n = 0;
    for (size_t i = 5; i < w.size(); i += w[i] >> 16) n += spv::Op(w[i] & 0xffff) == spv::Op::OpLabel;
    return n;
  };
  for (const auto& [calls_of_block, cuts] : {std::pair{1u, 7}, {4u, 1}, {100u, 0}}) {
    INFO(calls_of_block);
    const auto cut = with_short_blocks(words, calls_of_block);
    CHECK(labels(cut) == labels(words) + cuts);
    CHECK(validate_spirv(cut) == "");
  }
}

TEST_CASE("a macro counts with its arguments, its largest definition, and once in itself") {
  const auto fits = [](const std::string& text) {
    TokenCount count;
    count.add("a.comp", text);
    try {
      count.check();
    } catch (const UserError&) {
      return false;
    }
    return true;
  };
  const auto power = [](int n, const std::string& first) {
    return "#define P0 " + first + "\n" + times(n, [](int i) {
             const std::string p = " P" + std::to_string(i);
             return "#define P" + std::to_string(i + 1) + p + p + "\n";
           });
  };
  CHECK(fits(power(19, "x") + "P19\n"));  // 2^19 tokens are as many as may be
  CHECK_FALSE(fits(power(19, "x") + "P19 x\n"));
  CHECK_FALSE(fits(power(18, "a /* b */ c \\\n d") + "P18\n"));
  CHECK(fits(power(40, "x") + "// P40\n#if P40\n#endif\n"));
  CHECK_FALSE(fits(power(40, "x") + "#define S(a, b) b\nS(1, P40)\n"));
  CHECK(fits(power(40, "x") + "#define S(a, b) b\nS(P40, 1)\n"));
  CHECK_FALSE(fits("#define A x\n#undef A\n" + power(30, "x") + "#define A P30\nA\n"));
  CHECK(fits("#define A A A\nA\n"));
}

TEST_CASE("a device without an end is not read as a module") {
  CHECK_THROWS_WITH(read_spirv("/dev/zero"), Contains("/dev/zero: error: cannot read the shader"));
}

TEST_CASE("work on a deep stack may recurse deep, returns its value, and passes exceptions on") {
  const std::function<int(int)> depth = [&](int n) {
    volatile char frame[1024];
    frame[0] = 1;
    return n == 0 ? 0 : frame[0] + depth(n - 1);
  };
  CHECK(with_deep_stack([&] { return depth(100'000); }) == 100'000);
  CHECK_THROWS_WITH(with_deep_stack([]() -> int { throw UserError("a.comp: error: x"); }),
                    "a.comp: error: x");
}

}  // namespace
}  // namespace glint::frontend
