// Tests that shaders too large for the optimiser's pass to SSA form compute what C++ computes, and that
// promoted modules stay valid.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/promoted_variables.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <utility>

#include "frontend/spirv/spirv.h"
#include "tests/support/catch.h"
#include "tests/unit/frontend/shader_lab.h"

namespace glint::frontend {
namespace {

const std::vector<uint32_t> kSourceWords = {0,  1,   2,    3,           7,           31,
                                            32, 100, 1999, 0x7fff'ffff, 0xdead'beef, 0x1234'5678};

std::string repeated(int n, const std::function<std::string(std::string)>& text) {
  std::string all;
  for (int i = 0; i < n; ++i) all += text(std::to_string(i));
  return all;
}

long occurrences(const Words& words, spv::Op op) {
  long n = 0;
  for (size_t at = kHeaderWords; at < words.size(); at += words[at] >> 16) n += op_of(words[at]) == op;
  return n;
}

TEST_CASE("thousands of selections, in a loop with continue and break, compute what they say") {
  constexpr uint32_t kSelections = 1200;
  const std::string code = repeated(kSelections, [](const std::string& k) {
    return "if (((x >> (" + k + "u & 31u)) & 1u) != 0u) y = y * 3u + z; else { z ^= y + " + k + "u; }\n";
  });
  const auto got = lab::run(
      kSourceWords, "uint z = 1u, w;\nfor (uint i = 0u; i < 4u; ++i) {\nif (i == (x & 3u)) continue;\n" +
                        code + "if (y > 0xf0000000u) break;\nif (i == 3u) w = y;\n y += w & 0u;\n}\ny += z;");
  for (size_t lane = 0; lane < kSourceWords.size(); ++lane) {
    const uint32_t x = kSourceWords[lane];
    uint32_t y = 0, z = 1;
    for (uint32_t i = 0; i < 4; ++i) {
      if (i == (x & 3)) continue;
      for (uint32_t k = 0; k < kSelections; ++k)
        if ((x >> (k & 31)) & 1)
          y = y * 3 + z;
        else
          z ^= y + k;
      if (y > 0xf000'0000) break;
    }
    CAPTURE(x);
    CHECK(got[lane] == y + z);
  }
}

TEST_CASE("a switch with thousands of cases and a chain of a thousand `else if` compute what they say") {
  const auto cases = [](const std::string& k) {
    return "case " + k + ": y = y * 5u + " + k + "u;" +
           (k.back() == '7' ? "\n" : " break;\n");  // 7 falls through.
  };
  const auto chain = [](const std::string& k) {
    return "if ((x & 0x3ffu) == " + k + "u) y += " + k + "u * 7u;\nelse ";
  };
  const auto got = lab::run(kSourceWords, "y = 3u;\nswitch (int(x)) {\n" + repeated(2000, cases) +
                                              "default: y ^= x; }\n" + repeated(1000, chain) + "y += 11u;\n");
  for (size_t lane = 0; lane < kSourceWords.size(); ++lane) {
    const uint32_t x = kSourceWords[lane];
    uint32_t y = 3;
    if (x >= 2000) y ^= x;
    if (x < 2000) {
      y = y * 5 + x;
      if (x % 10 == 7) y = y * 5 + x + 1;
    }
    const uint32_t link = x & 0x3ff;
    y += link < 1000 ? link * 7 : 11;
    CAPTURE(x);
    CHECK(got[lane] == y);
  }
}

TEST_CASE("promoted modules are valid, and a second promotion finds nothing") {
  int tried = 0;
  for (const auto& file :
       std::filesystem::recursive_directory_iterator(std::string(GLINT_SOURCE_DIR) + "/tests/shaders/glsl")) {
    const std::string path = file.path().string();
    if (!stage_of_file(path)) continue;
    CAPTURE(path);
    Words words;
    try {
      words = glsl_to_spirv(path, {});
    } catch (const Error&) {
      continue;  // Some are mistakes on purpose, and some need macros.
    }
    ++tried;
    const Words promoted = with_promoted_variables(words, 0);
    CHECK(validate_spirv(promoted) == "");
    CHECK(occurrences(promoted, spv::Op::OpVariable) <= occurrences(words, spv::Op::OpVariable));
    CHECK(with_promoted_variables(promoted, 0) == promoted);
    CHECK(with_promoted_variables(words, 1'000'000) == words);
  }
  CHECK(tried > 50);
}

TEST_CASE("a value that nothing has stored is undefined, and an initial value counts as stored") {
  const Words words = assemble_spirv(R"(
OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %out
OpExecutionMode %main LocalSize 1 1 1
OpName %a "a"
OpDecorate %a RelaxedPrecision
OpDecorate %load RelaxedPrecision
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpDecorate %out DescriptorSet 0
OpDecorate %out Binding 0
%void = OpTypeVoid
%function = OpTypeFunction %void
%uint = OpTypeInt 32 0
%bool = OpTypeBool
%seven = OpConstant %uint 7
%zero = OpConstant %uint 0
%pointer = OpTypePointer Function %uint
%block = OpTypeStruct %uint
%to_block = OpTypePointer StorageBuffer %block
%to_word = OpTypePointer StorageBuffer %uint
%out = OpVariable %to_block StorageBuffer
%main = OpFunction %void None %function
%entry = OpLabel
%a = OpVariable %pointer Function %seven
%b = OpVariable %pointer Function
%kept = OpVariable %pointer Function
%load = OpLoad %uint %a
%hidden = OpLoad %uint %kept Volatile
%is = OpIEqual %bool %load %hidden
OpSelectionMerge %end None
OpBranchConditional %is %then %end
%then = OpLabel
OpStore %b %load
OpBranch %end
%end = OpLabel
%sum = OpLoad %uint %b
%place = OpAccessChain %to_word %out %zero
OpStore %place %sum
OpReturn
OpFunctionEnd
)",
                                     "t.spvasm");
  const Words promoted = with_promoted_variables(words, 0);
  CHECK(validate_spirv(promoted) == "");
  CHECK(occurrences(promoted, spv::Op::OpVariable) == 2);  // the block and the volatile variable
  CHECK(occurrences(promoted, spv::Op::OpPhi) == 1);
  CHECK(occurrences(promoted, spv::Op::OpUndef) == 1);
  CHECK(occurrences(promoted, spv::Op::OpName) == 0);
  CHECK(occurrences(promoted, spv::Op::OpDecorate) == occurrences(words, spv::Op::OpDecorate) - 2);
}

TEST_CASE("phis are tried only where stores of a variable meet, however many selections follow") {
  constexpr uint32_t kManyVariables = 300;
  const auto all = [](const std::function<std::string(std::string)>& text) {
    return repeated(kManyVariables, text);
  };
  const std::string code =
      "#version 460\nlayout(local_size_x = 1) in;\nlayout(binding = 0) buffer Out { uint v[]; };\nvoid "
      "main() {\n"
      "uint x = v[0];\n" +
      all([](const std::string& k) { return "uint a" + k + " = " + k + "u;\n"; }) +
      all([](const std::string& k) { return "if (x > " + k + "u) a" + k + " = v[" + k + "];\n"; }) +
      all([](const std::string& k) { return "v[" + k + "] = a" + k + ";\n"; }) + "}\n";
  const Words words = glsl_text_to_spirv(code, "t.comp", isa::Stage::Compute, {});
  const Words promoted = with_promoted_variables(words, 0);
  CHECK(validate_spirv(promoted) == "");
  CHECK(occurrences(promoted, spv::Op::OpPhi) == kManyVariables);
  // Each phi that is tried takes an id.
  CHECK(promoted[kBoundWord] == words[kBoundWord] + kManyVariables);
}

TEST_CASE("variables stored in cases that fall through, and read behind loops, have the values they say") {
  constexpr uint32_t kManyVariables = 300;
  const auto all = [](const std::function<std::string(std::string)>& text) {
    return repeated(kManyVariables, text);
  };
  const auto got = lab::run(
      kSourceWords,
      all([](const std::string& k) { return "uint a" + k + " = x + " + k + "u;\n"; }) +
          "for (uint i = 0u; i < 3u; ++i) {\nif ((x & 3u) == i) continue;\nswitch (int(x) + 7 * int(i)) {\n" +
          all([](const std::string& k) {
            return "case " + k + ": { uint t = a" + k + "; if ((t & 1u) != 0u) t += i; a" + k +
                   " = t * 3u; " + (k.back() == '5' ? "break; }\n" : "}\n");
          }) +
          "}\nif (a9 > 0xf0000000u) break;\n}\n" +
          all([](const std::string& k) { return "y = y * 31u + a" + k + ";\n"; }));
  for (size_t lane = 0; lane < kSourceWords.size(); ++lane) {
    const uint32_t x = kSourceWords[lane];
    std::vector<uint32_t> a;
    for (uint32_t k = 0; k < kManyVariables; ++k) a.push_back(x + k);
    for (uint32_t i = 0; i < 3; ++i) {
      if ((x & 3) == i) continue;
      for (uint32_t k = x + 7 * i; k < kManyVariables; ++k) {
        a[k] = (a[k] + (a[k] & 1 ? i : 0)) * 3;
        if (k % 10 == 5) break;
      }
      if (a[9] > 0xf000'0000) break;
    }
    uint32_t y = 0;
    for (const uint32_t each : a) y = y * 31 + each;
    CAPTURE(x);
    CHECK(got[lane] == y);
  }
}

TEST_CASE("matrices, structs and arrays that are stored as a whole are promoted in a very large shader") {
  const std::string globals =
      "struct Pair { uint a; uvec2 b; };\n"
      "Pair turned(Pair p, uint k) { Pair q = p; if ((p.a & 1u) != 0u) q = Pair(p.b.y + k, p.b); return q; "
      "}\n"
      "mat2 stepped(mat2 m, bool b) { mat2 n = m; if (b) n = mat2(m[1], m[0] + vec2(1.0)); return n; }\n";
  constexpr uint32_t kSteps = 700;
  const std::string code =
      "Pair p = Pair(x, uvec2(x * 3u, 5u));\nmat2 m = mat2(0.0);\n" +
      repeated(kSteps,
               [](const std::string& k) {
                 return "p = turned(p, " + k + "u); m = stepped(m, (x & " + k + "u) == 0u); p.b.x += p.a;\n";
               }) +
      "y = p.a + p.b.x + uint(m[0].x + 2.0 * m[1].y);";
  const auto got = lab::run(kSourceWords, code, globals);
  for (size_t lane = 0; lane < kSourceWords.size(); ++lane) {
    const uint32_t x = kSourceWords[lane];
    uint32_t a = x, b = x * 3, c = 5;
    float m[4] = {0, 0, 0, 0};
    for (uint32_t k = 0; k < kSteps; ++k) {
      if (a & 1) a = c + k;
      if ((x & k) == 0) {
        std::swap(m[0], m[2]), std::swap(m[1], m[3]);
        m[2] += 1, m[3] += 1;
      }
      b += a;
    }
    CAPTURE(x);
    CHECK(got[lane] == a + b + uint32_t(m[0] + 2 * m[3]));
  }
}

}  // namespace
}  // namespace glint::frontend
