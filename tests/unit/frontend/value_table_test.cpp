// Turns tables of operands and results into shaders, and tests that a wrong result is detected.
// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/frontend/value_table.h"

#include <fmt/format.h>

#include "tests/support/catch.h"
#include "tests/unit/frontend/shader_lab.h"

namespace glint::frontend::lab {
namespace {

std::string function(const std::string& expression) {
  return "uint bits(float x) { return floatBitsToUint(x); }\nuint bits(uint x) { return x; }\nuint bits(int "
         "x) { return uint(x); }\n"
         "uint bits(bool x) { return x ? 1u : 0u; }\n"
         "uint compute(uint A, uint B, uint C) { float a = uintBitsToFloat(A), b = uintBitsToFloat(B), c = "
         "uintBitsToFloat(C);"
         " int i = int(A), j = int(B), k = int(C); return bits(" +
         expression + "); }\n";
}

std::vector<uint32_t> from_memory(const std::string& expression, const std::vector<Case>& cases,
                                  const std::string& globals) {
  std::string tables;
  const auto table = [&](char name, uint32_t Case::*member) {
    tables += fmt::format("const uint k{}[{}] = uint[](", name, cases.size());
    for (size_t i = 0; i < cases.size(); ++i) tables += fmt::format("{}{}u", i ? ", " : "", cases[i].*member);
    tables += ");\n";
  };
  table('A', &Case::a), table('B', &Case::b), table('C', &Case::c);
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < cases.size(); ++i) indices.push_back(i);
  return run(indices, "y = compute(kA[x], kB[x], kC[x]);", globals + function(expression) + tables);
}

std::vector<uint32_t> folded(const std::string& expression, const std::vector<Case>& cases,
                             const std::string& globals) {
  std::string constants, statements = "switch (x) {";
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < cases.size(); ++i) {
    const auto [a, b, c, result] = cases[i];
    constants += fmt::format(
        "layout(constant_id = {0}) const uint A{3} = {4}u;\nlayout(constant_id = {1}) const uint B{3} = "
        "{5}u;\n"
        "layout(constant_id = {2}) const uint C{3} = {6}u;\n",
        3 * i, 3 * i + 1, 3 * i + 2, i, a, b, c);
    statements += fmt::format("case {0}u: y = compute(A{0}, B{0}, C{0}); break;\n", i);
    indices.push_back(i);
  }
  return run(indices, statements + "}", globals + function(expression) + constants);
}

bool is_nan(uint32_t bits) {
  return (bits & kIntMax) > kInf;
}

// Returns the cases whose results differ.
std::string differences(const std::vector<uint32_t>& got, const std::vector<Case>& cases) {
  std::string text;
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto [a, b, c, result] = cases[i];
    if (got[i] == result || (result == kNan && is_nan(got[i]))) continue;
    text += fmt::format("({:#x}, {:#x}, {:#x}) gives {:#x}, not {:#x}\n", a, b, c, got[i], result);
  }
  return text;
}

TEST_CASE("a table with a wrong result is seen") {
  const std::vector<Case> cases{{1, 2, 0, 3}, {5, 6, 0, 12}};
  CHECK(differences(from_memory("A + B", cases, ""), cases) == "(0x5, 0x6, 0x0) gives 0xb, not 0xc\n");
  CHECK(differences(folded("A + B", cases, ""), cases) == "(0x5, 0x6, 0x0) gives 0xb, not 0xc\n");
}

}  // namespace

void check_cases(const std::string& expression, const std::vector<Case>& cases, const std::string& globals) {
  INFO(expression);
  CHECK(differences(from_memory(expression, cases, globals), cases) == "");
  INFO("with constants");
  CHECK(differences(folded(expression, cases, globals), cases) == "");
}

}  // namespace glint::frontend::lab
