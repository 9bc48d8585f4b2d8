// Checks --contract: a product and a sum become one fma, bit for bit, unless the shader says `precise` or the
// option is off.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <random>

#include "isa/op_row.h"
#include "tests/print/shader_run.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

uint32_t bits_of(float x) {
  return std::bit_cast<uint32_t>(x);
}

// Stores `expression` of a, b, c and d, which are words 0 to 3, to word 4.
std::string shader_of(const std::string& expression, const std::string& type = "float") {
  return "#extension GL_EXT_shader_explicit_arithmetic_types : require\nlayout(local_size_x = 1) in;\n"
         "layout(set = 0, binding = 0) buffer W { float a, b, c, d, r; };\nvoid main() { " +
         type + " x = " + expression + "; r = float(x); }\n";
}

size_t count(const isa::Program& program, std::string_view name) {
  size_t out = 0;
  for (const isa::Inst& inst : program.code) out += isa::op_table()[inst.op].name == name;
  return out;
}

void check(const std::string& expression, float (*fused)(float, float, float, float),
           float (*apart)(float, float, float, float), bool precise = false) {
  INFO(expression);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> near_one(0.5f, 2.0f);
  int different = 0;
  ShaderRun runs[2];
  runs[1].backend.contract = true;
  const std::string text = shader_of(expression, precise ? "precise float" : "float");
  const isa::Program programs[2] = {compile_text(runs[0], text), compile_text(runs[1], text)};
  for (int i = 0; i < 50; ++i) {
    float v[4];
    for (float& x : v) x = near_one(random);
    const float expected[2] = {apart(v[0], v[1], v[2], v[3]),
                               (precise ? apart : fused)(v[0], v[1], v[2], v[3])};
    different += bits_of(fused(v[0], v[1], v[2], v[3])) != bits_of(expected[0]);
    for (const int k : {0, 1}) {
      runs[k].words = {bits_of(v[0]), bits_of(v[1]), bits_of(v[2]), bits_of(v[3]), 0};
      run_program(runs[k], programs[k]);
      CHECK(runs[k].words[4] == bits_of(expected[k]));
    }
  }
  CHECK(different > 5);  // otherwise the loop has shown nothing
}

// `volatile` keeps the host's compiler from fusing these.
float mul(float a, float b) {
  volatile float r = a * b;
  return r;
}
float add(float a, float b) {
  volatile float r = a + b;
  return r;
}

TEST_CASE("sums and differences of products are fused with --contract and rounded twice without it") {
  check(
      "a * b + c", [](float a, float b, float c, float) { return std::fma(a, b, c); },
      [](float a, float b, float c, float) { return add(mul(a, b), c); });
  check(
      "c + a * b", [](float a, float b, float c, float) { return std::fma(a, b, c); },
      [](float a, float b, float c, float) { return add(mul(a, b), c); });
  check(
      "a * b - c", [](float a, float b, float c, float) { return std::fma(a, b, -c); },
      [](float a, float b, float c, float) { return add(mul(a, b), -c); });
  check(
      "c - a * b", [](float a, float b, float c, float) { return std::fma(-a, b, c); },
      [](float a, float b, float c, float) { return add(c, -mul(a, b)); });
  check(
      "a * b - c * d", [](float a, float b, float c, float d) { return std::fma(a, b, -mul(c, d)); },
      [](float a, float b, float c, float d) { return add(mul(a, b), -mul(c, d)); });
  check(
      "dot(vec2(a, b), vec2(c, d))",
      [](float a, float b, float c, float d) { return std::fma(a, c, mul(b, d)); },
      [](float a, float b, float c, float d) { return add(mul(a, c), mul(b, d)); });
}

TEST_CASE("a precise expression is rounded twice with --contract too") {
  check(
      "a * b + c", [](float a, float b, float c, float) { return std::fma(a, b, c); },
      [](float a, float b, float c, float) { return add(mul(a, b), c); }, true);
}

TEST_CASE("a product that something else reads stays, and nothing is fused without --contract") {
  ShaderRun on, off;
  on.backend.contract = true;
  const std::string twice =
      "layout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer W { float a, b, c, d, r; };\n"
      "void main() { float p = a * b; r = p + c; d = p; }\n";
  CHECK(count(compile_text(on, twice), "fma.rn.f32") == 0);
  const std::string once = shader_of("a * b + c");
  CHECK(count(compile_text(off, once), "fma.rn.f32") == 0);
  const isa::Program fused = compile_text(on, once);
  CHECK(count(fused, "fma.rn.f32") == 1);
  CHECK(count(fused, "mul.rn.f32") == 0);
}

TEST_CASE("halves and doubles are fused by their own ops, and built-in functions are left as they are") {
  ShaderRun on, off;
  on.backend.contract = true;
  CHECK(count(compile_text(on, shader_of("double(a) * double(b) + double(c)", "double")), "fma.rn.f64") == 1);
  CHECK(count(compile_text(on, shader_of("float16_t(a) * float16_t(b) + float16_t(c)", "float16_t")),
              "fma.rn.f16") == 1);
  CHECK(compile_text(on, shader_of("exp(a) + atan(b) * 2.0")).code.size() ==
        compile_text(off, shader_of("exp(a) + atan(b) * 2.0")).code.size() - 1);
}

}  // namespace
}  // namespace glint::test
