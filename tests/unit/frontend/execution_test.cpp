// Runs compute shaders from GLSL to results: integer and float ops, functions with their errors, memory
// layouts.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/support/catch.h"
#include "tests/unit/frontend/shader_lab.h"

namespace glint::frontend {
namespace {

using lab::run;
using lab::run_f32;

const std::vector<uint32_t> kWords = {
    0, 1, 2, 3, 7, 31, 32, 100, 0x7fff'ffff, 0x8000'0000, 0x8000'0001, 0xffff'ffff, 0xdead'beef, 0x1234'5678};

void check_words(const std::string& statements, const std::function<uint32_t(uint32_t)>& expected,
                 const std::string& globals = "") {
  const auto got = run(kWords, statements, globals);
  INFO(statements);
  for (size_t i = 0; i < kWords.size(); ++i) {
    INFO("x = " << kWords[i]);
    CHECK(got[i] == expected(kWords[i]));
  }
}

// Returns the distance in units in the last place of the expected value. Doubles are rounded to float.
double ulps(float got, double expected) {
  if (std::isnan(got) || std::isnan(expected)) return std::isnan(got) == std::isnan(expected) ? 0 : 1e30;
  if (std::isinf(float(expected)) || std::isinf(got)) return got == float(expected) ? 0 : 1e30;
  int exponent = 0;
  std::frexp(expected, &exponent);
  return std::abs(got - expected) / std::ldexp(1.0, std::max(exponent, -125) - 24);
}

void check_function(const std::string& expression, const std::vector<float>& inputs, double limit_ulps,
                    double limit_absolute, const std::function<double(double)>& expected) {
  const auto got = run_f32(inputs, expression);
  INFO(expression);
  for (size_t i = 0; i < inputs.size(); ++i) {
    INFO("f = " << inputs[i] << " gives " << got[i] << ", expected " << expected(inputs[i]));
    CHECK((ulps(got[i], expected(inputs[i])) <= limit_ulps ||
           std::abs(got[i] - expected(inputs[i])) <= limit_absolute));
  }
}

std::vector<float> spread(float low, float high, int n = 200) {
  std::vector<float> result;
  for (int i = 0; i < n; ++i) result.push_back(low + (high - low) * float(i) / float(n - 1));
  return result;
}

TEST_CASE("integer arithmetic wraps and divides as GLSL says") {
  check_words("y = (x + 5u) * 3u - (x >> 3) + (x << 2);",
              [](uint32_t x) { return (x + 5) * 3 - (x >> 3) + (x << 2); });
  check_words("y = x / 7u + x % 10u + x / 16u + x % 8u;",
              [](uint32_t x) { return x / 7 + x % 10 + x / 16 + x % 8; });
  check_words("y = uint(int(x) / -7);", [](uint32_t x) { return uint32_t(int32_t(x) / -7); });
  check_words("y = uint(int(x) >> 4) ^ uint(-int(x)) ^ ~x;",
              [](uint32_t x) { return uint32_t(int32_t(x) >> 4) ^ (0u - x) ^ ~x; });
  check_words("y = uint(max(min(int(x), 50), -50)) + max(min(x, 90u), 30u);", [](uint32_t x) {
    return uint32_t(std::max(std::min(int32_t(x), 50), -50)) + std::max(std::min(x, 90u), 30u);
  });
}

TEST_CASE("bit functions follow GLSL, also at zero") {
  check_words("y = uint(findLSB(x));", [](uint32_t x) { return x ? uint32_t(std::countr_zero(x)) : ~0u; });
  check_words("y = uint(findMSB(x));",
              [](uint32_t x) { return x ? 31u - uint32_t(std::countl_zero(x)) : ~0u; });
  check_words("y = uint(findMSB(int(x)));", [](uint32_t x) {
    const uint32_t v = int32_t(x) < 0 ? ~x : x;
    return v ? 31u - uint32_t(std::countl_zero(v)) : ~0u;
  });
  check_words("y = uint(bitCount(x)) + bitfieldExtract(x, 4, 8);",
              [](uint32_t x) { return uint32_t(std::popcount(x)) + (x >> 4 & 0xff); });
  check_words("y = uint(bitfieldExtract(int(x), 4, 8));",
              [](uint32_t x) { return uint32_t(int32_t(x << 20) >> 24); });
  check_words("y = bitfieldInsert(x, 0x2bu, 8, 6);", [](uint32_t x) { return (x & ~0x3f00u) | 0x2b00u; });
  check_words("uint high, low; umulExtended(x, 0x87654321u, high, low); y = high ^ low;", [](uint32_t x) {
    const uint64_t p = uint64_t(x) * 0x87654321u;
    return uint32_t(p >> 32) ^ uint32_t(p);
  });
  check_words("uint c; uint s = uaddCarry(x, 0x80000001u, c); y = s + c * 7u;", [](uint32_t x) {
    const uint32_t s = x + 0x80000001u;
    return s + (s < x ? 7u : 0u);
  });
}

TEST_CASE("64-bit integers go through pairs of registers") {
  const std::string extension = "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n";
  check_words(
      "uint64_t w = uint64_t(x) * 0x100000007ul + 9ul; w ^= w >> 29; y = uint(w >> 32) + uint(w);",
      [](uint32_t x) {
        uint64_t w = uint64_t(x) * 0x1'0000'0007ull + 9;
        w ^= w >> 29;
        return uint32_t(w >> 32) + uint32_t(w);
      },
      extension);
  check_words(
      "int64_t w = int64_t(int(x)); uvec2 p = unpackUint2x32(uint64_t(w)); y = p.y + (w < 0l ? 1u : 0u) + "
      "uint(packUint2x32(p.yx));",
      [](uint32_t x) {
        const uint32_t high = int32_t(x) < 0 ? ~0u : 0;
        return high + (int32_t(x) < 0) + high;
      },
      extension);
}

TEST_CASE("comparisons with NaN are false, but inequality") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto bits =
      run({std::bit_cast<uint32_t>(nan), std::bit_cast<uint32_t>(1.0f), std::bit_cast<uint32_t>(2.0f)},
          "y = (f < 2.0 ? 1u : 0u) | (f <= 1.0 ? 2u : 0u) | (f > 1.0 ? 4u : 0u) | (f >= 2.0 ? 8u : 0u) | (f "
          "== f ? 16u : 0u) | (f != 1.0 ? 32u : 0u)"
          " | (!(f < 2.0) ? 64u : 0u) | (isnan(f) ? 128u : 0u) | (isinf(f / 0.0) ? 256u : 0u);");
  CHECK(bits == std::vector<uint32_t>{32 | 64 | 128, 1 | 2 | 16 | 256, 4 | 8 | 16 | 32 | 64 | 256});
}

TEST_CASE("float to integer conversion truncates and saturates") {
  const std::vector<float> in{0.9f, -0.9f, 3.7f, -3.7f, 3e9f, -3e9f, 1e20f};
  std::vector<uint32_t> bits;
  for (float f : in) bits.push_back(std::bit_cast<uint32_t>(f));
  CHECK(run(bits, "y = uint(int(f));") ==
        std::vector<uint32_t>{0, 0, 3, uint32_t(-3), 0x7fff'ffff, 0x8000'0000, 0x7fff'ffff});
  CHECK(run({0x8000'0000, 0xffff'ffff, 16777217}, "y = floatBitsToUint(float(x));") ==
        std::vector<uint32_t>{0x4f00'0000, 0x4f80'0000, 0x4b80'0000});
}

TEST_CASE("sums of products are not contracted") {
  const float a = 1.0f + std::ldexp(1.0f, -12), c = -(1.0f + std::ldexp(1.0f, -11));
  const auto got = run_f32({a}, "f * f + " + std::to_string(-1) + ".0 * " + "(1.0 + exp2(-11.0))");
  CHECK(got[0] == a * a + c);  // an fma would give 2^-24
  CHECK(run_f32({a}, "fma(f, f, -(1.0 + exp2(-11.0)))")[0] == std::ldexp(1.0f, -24));
}

TEST_CASE("rounding functions give the exact results") {
  const std::vector<float> in{-2.5f, -1.5f, -0.5f, -0.2f, 0.0f, 0.5f, 1.5f, 2.5f, 3.2f, 8388609.0f};
  check_function("floor(f)", in, 0, 0, [](double x) { return std::floor(x); });
  check_function("ceil(f)", in, 0, 0, [](double x) { return std::ceil(x); });
  check_function("trunc(f)", in, 0, 0, [](double x) { return std::trunc(x); });
  check_function("roundEven(f)", in, 0, 0, [](double x) { return std::nearbyint(x); });
  check_function("fract(f)", in, 0.5, 0, [](double x) { return x - std::floor(x); });
  check_function("sign(f)", in, 0, 0, [](double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; });
  check_function("mod(f, 0.75)", in, 0.5, 0, [](double x) { return x - 0.75 * std::floor(x / 0.75); });
  check_function("step(0.5, f)", in, 0, 0, [](double x) { return x < 0.5 ? 0.0 : 1.0; });
  check_function("clamp(f, -1.0, 2.0)", in, 0, 0, [](double x) { return std::min(std::max(x, -1.0), 2.0); });
  check_function("mix(2.0, 6.0, f)", in, 1, 0, [](double x) { return 2 * (1 - x) + 6 * x; });
}

TEST_CASE("inverse trigonometric functions stay within 4 ulp") {
  check_function("asin(f)", spread(-1, 1), 4, 0, [](double x) { return std::asin(x); });
  check_function("acos(f)", spread(-1, 1), 4, 2e-7, [](double x) { return std::acos(x); });
  check_function("atan(f)", spread(-20, 20), 4, 0, [](double x) { return std::atan(x); });
  check_function("atan(f, 0.7)", spread(-20, 20), 4, 0, [](double x) { return std::atan2(x, double(0.7f)); });
  check_function("atan(f, -0.7)", spread(-20, 20), 4, 0,
                 [](double x) { return std::atan2(x, double(-0.7f)); });
  check_function("atan(0.7, f)", spread(-20, 20), 4, 0, [](double x) { return std::atan2(double(0.7f), x); });
  CHECK(run_f32({0.0f, -0.0f}, "atan(f, 0.0)") == std::vector<float>{0.0f, -0.0f});
}

TEST_CASE("exponentials, logarithms and powers are within Vulkan's bounds") {
  check_function("exp(f)", spread(-10, 10), 3 + 2 * 10, 0, [](double x) { return std::exp(x); });
  check_function("log(f)", spread(0.01f, 50), 4, 1e-6, [](double x) { return std::log(x); });
  check_function("sqrt(f)", spread(0, 50), 0.5, 0, [](double x) { return std::sqrt(x); });
  check_function("inversesqrt(f)", spread(0.1f, 50), 2, 0, [](double x) { return 1 / std::sqrt(x); });
  check_function("pow(f, 5.0)", spread(0.01f, 3), 64, 0, [](double x) { return std::pow(x, 5.0); });
  check_function("sin(f)", spread(-3.14f, 3.14f), 0, 0.0005, [](double x) { return std::sin(x); });
  check_function("tan(f)", spread(-1.0f, 1.0f), 0, 0.002, [](double x) { return std::tan(x); });
  CHECK(run_f32({0.0f, 5.0f}, "pow(f, f - f)") == std::vector<float>{1.0f, 1.0f});
}

TEST_CASE("geometric functions follow their GLSL formulas") {
  CHECK(run_f32({3.0f}, "length(vec2(f, 4.0)) + distance(vec3(f, 1, 2), vec3(f, 1, 9))") ==
        std::vector<float>{12.0f});
  CHECK(run_f32({3.0f}, "dot(cross(vec3(f, 0, 0), vec3(0, 2, 0)), vec3(100, 10, 1))") ==
        std::vector<float>{6.0f});
  CHECK(run_f32({3.0f}, "dot(reflect(vec3(f, -4, 5), vec3(0, 1, 0)), vec3(100, 10, 1))") ==
        std::vector<float>{345.0f});
  // This is total reflection.
  CHECK(run_f32({2.0f}, "dot(refract(vec3(1, 0, 0), vec3(0, 1, 0), f), vec3(1))") ==
        std::vector<float>{0.0f});
  CHECK(run_f32({1.0f}, "dot(refract(vec3(0, -1, 0), vec3(0, 1, 0), f), vec3(1, 10, 1))") ==
        std::vector<float>{-10.0f});
  CHECK(run_f32({1.0f}, "faceforward(vec2(f, 2), vec2(1), vec2(1)).y") == std::vector<float>{-2.0f});
  CHECK(run_f32({3.0f}, "normalize(vec2(f, 4.0)).x") == std::vector<float>{0.6f});
  CHECK(run_f32({0.25f}, "smoothstep(0.0, 1.0, f)") == std::vector<float>{0.15625f});
}

TEST_CASE("matrix products go by columns, and inverses are inverses") {
  const std::string m = "mat3 m = mat3(1, 2, 3, 4, 5, 6, 7, 8, f); mat2x3 n = mat2x3(1, 0, 2, 3, f, 1);";
  const auto y = [&](const std::string& e) {
    return std::bit_cast<float>(
        run({std::bit_cast<uint32_t>(10.0f)}, m + "y = floatBitsToUint(" + e + ");")[0]);
  };
  CHECK(y("dot(m * vec3(1, 10, 100), vec3(1, 0, 0))") == 741.0f);
  CHECK(y("dot(vec3(1, 10, 100) * m, vec3(1, 0, 0))") == 321.0f);
  CHECK(y("(m * n)[1][2]") == 3 * 3 + 10 * 6 + 1 * 10.0f);
  CHECK(y("transpose(m)[2][0]") == 3.0f);
  CHECK(y("outerProduct(vec2(2, 3), vec3(5, 7, f))[2][1]") == 30.0f);
  CHECK(y("determinant(m)") == -3.0f);
  CHECK(std::abs(y("(inverse(m) * m)[1][1] + (inverse(m) * m)[2][0]") - 1) < 1e-5f);
  CHECK(y("(2.0 * m)[2][2] + matrixCompMult(m, m)[1][0]") == 36.0f);
}

TEST_CASE("dynamic indices reach the right component, element and column") {
  const std::vector<uint32_t> in{0, 1, 2, 3};
  CHECK(run(in, "uvec4 v = uvec4(10, 20, 30, 40); y = v[x];") == std::vector<uint32_t>{10, 20, 30, 40});
  CHECK(run(in,
            "uvec4 v = uvec4(10, 20, 30, 40); v[x] = 7u; y = v.x * 1000u + v.y * 100u + v.z * 10u + v.w;") ==
        std::vector<uint32_t>{7 * 1000 + 2000 + 300 + 40, 10000 + 700 + 300 + 40, 10000 + 2000 + 70 + 40,
                              10000 + 2000 + 300 + 7});
  CHECK(run(in, "uint a[5]; for (int k = 0; k < 5; ++k) a[k] = uint(k * k) + x; y = a[x + 1];") ==
        std::vector<uint32_t>{1, 5, 11, 19});
  CHECK(run(in, "y = kTable[x].b.y + kTable[3 - x].a;",
            "struct S { uint a; uvec2 b; };\nconst S kTable[4] = S[](S(1, uvec2(2, 3)), S(4, uvec2(5, 6)), "
            "S(7, uvec2(8, 9)), S(10, uvec2(11, 12)));\n") == std::vector<uint32_t>{13, 13, 13, 13});
  CHECK(run(in, "bool b[4]; for (int k = 0; k < 4; ++k) b[k] = (k & 1) != 0; y = b[x] ? 1u : 2u;") ==
        std::vector<uint32_t>{2, 1, 2, 1});
}

TEST_CASE("buffers are read and written by their decorated layout") {
  // The test binds one buffer under several layouts: binding 1 again, as structs of std430, scalar and std140
  // members.
  const std::string globals =
      "struct A { float a; vec3 b; };\nlayout(binding = 1, std430) buffer P { A p[]; } std430_view;\n"
      "layout(binding = 1, scalar) buffer Q { A q[]; } scalar_view;\nlayout(binding = 1, std430, row_major) "
      "buffer R { mat3x2 m; } rows;\n"
      "layout(binding = 1, std430) buffer C { mat3x2 m; } columns;\n";
  std::vector<uint32_t> in(16);
  for (uint32_t i = 0; i < 16; ++i) in[i] = i;
  const auto words = [&](const std::string& s) {
    return run(in, "if (i == 0) { " + s + " } return;", globals);
  };
  auto w = words("std430_view.p[0] = A(1.0, vec3(2, 3, 4));");
  CHECK((std::bit_cast<float>(w[0]) == 1 && w[1] == 0 && w[3] == 0 && std::bit_cast<float>(w[4]) == 2 &&
         std::bit_cast<float>(w[6]) == 4));
  w = words("scalar_view.q[1 + x] = A(1.0, vec3(2, 3, 4));");
  CHECK((std::bit_cast<float>(w[4]) == 1 && std::bit_cast<float>(w[5]) == 2 &&
         std::bit_cast<float>(w[7]) == 4));
  w = words("columns.m = mat3x2(1, 2, 3, 4, 5, 6);");  // stride 8: columns follow each other
  CHECK((std::bit_cast<float>(w[0]) == 1 && std::bit_cast<float>(w[2]) == 3 &&
         std::bit_cast<float>(w[5]) == 6));
  w = words("rows.m = mat3x2(1, 2, 3, 4, 5, 6);");  // stride 16: rows of three
  CHECK((std::bit_cast<float>(w[0]) == 1 && std::bit_cast<float>(w[1]) == 3 &&
         std::bit_cast<float>(w[4]) == 2 && std::bit_cast<float>(w[6]) == 6));
  w = words(
      "rows.m = mat3x2(1, 2, 3, 4, 5, 6); vec2 c = rows.m[x + 1]; outputs.values[8] = floatBitsToUint(c.y + "
      "rows.m[2][x]); ");
  CHECK(std::bit_cast<float>(w[8]) == 9);
  CHECK(run(in, "y = uint(outputs.values.length()) + x;")[3] == 19);
}

TEST_CASE("indices that fold into displacements give the same elements, also backwards") {
  const std::vector<uint32_t> in{4, 5, 6, 7, 8, 9};
  CHECK(run(in,
            "uint k = x - 4u; y = inputs.values[k + 1u < 6u ? k + 1u : k] * 10u + inputs.values[(k + 5u) - "
            "5u] + inputs.values[int(k) - int(i)];") ==
        std::vector<uint32_t>{50 + 4 + 4, 60 + 5 + 4, 70 + 6 + 4, 80 + 7 + 4, 90 + 8 + 4, 90 + 9 + 4});
}

TEST_CASE("few registers spill but compute the same") {
  std::string sum = "uint s = x;\n", use;
  for (int k = 0; k < 40; ++k)
    sum += "uint v" + std::to_string(k) + " = inputs.values[" + std::to_string(k % 8) + "] * " +
           std::to_string(k + 3) + "u + x;\n";
  for (int k = 0; k < 40; ++k) use += "s = s * 31u + v" + std::to_string(39 - k) + ";\n";
  const std::vector<uint32_t> in{1, 2, 3, 4, 5, 6, 7, 8};
  BackendOptions tight;
  tight.max_registers = 16;
  CHECK(run(in, sum + use + "y = s;", "", tight) == run(in, sum + use + "y = s;"));
}

}  // namespace
}  // namespace glint::frontend
