// Tests float arithmetic where it surprises: NaN, infinities, zeros, subnormals, ties, edges of functions.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/unit/frontend/value_table.h"

namespace glint::frontend::lab {
namespace {

constexpr float kPi = 3.14159265f;

TEST_CASE("min, max and clamp give the operand that is a number, and order the zeros") {
  check_cases("min(a, b)", {{kNan, f(1), 0, f(1)},
                            {f(1), kNan, 0, f(1)},
                            {kNan, kNan, 0, kNan},
                            {kMinusZero, 0, 0, kMinusZero},
                            {0, kMinusZero, 0, kMinusZero},
                            {kMinusInf, f(1), 0, kMinusInf},
                            {1, 2, 0, 1}});
  check_cases("max(a, b)", {{kNan, f(1), 0, f(1)},
                            {f(1), kNan, 0, f(1)},
                            {kNan, kNan, 0, kNan},
                            {kMinusZero, 0, 0, 0},
                            {0, kMinusZero, 0, 0},
                            {kMinusInf, f(1), 0, f(1)},
                            {1, 2, 0, 2}});
  check_cases("clamp(a, b, c)", {{kNan, f(1), f(2), f(1)},
                                 {f(5), f(3), f(1), f(1)},
                                 {f(0), f(3), f(1), f(1)},
                                 {f(5), kNan, f(2), f(2)},
                                 {f(5), f(1), kNan, f(5)},
                                 {f(1.5f), f(1), f(2), f(1.5f)}});
}

TEST_CASE("comparisons of floats are false for NaN but inequality, and zeros are equal") {
  const std::string all =
      "(a == b ? 1u : 0u) | (a != b ? 2u : 0u) | (a < b ? 4u : 0u) | (a <= b ? 8u : 0u) | (a > b ? 16u : 0u) "
      "| "
      "(a >= b ? 32u : 0u) | (isnan(a) ? 64u : 0u) | (isinf(a) ? 128u : 0u) | (!(a < b) ? 256u : 0u)";
  check_cases(all, {{kNan, f(1), 0, 2 | 64 | 256},
                    {f(1), kNan, 0, 2 | 256},
                    {kNan, kNan, 0, 2 | 64 | 256},
                    {0xffff'ffff, 0, 0, 2 | 64 | 256},
                    {kMinusZero, 0, 0, 1 | 8 | 32 | 256},
                    {kMinusInf, kInf, 0, 2 | 4 | 8 | 128},
                    {1, 2, 0, 2 | 4 | 8},
                    {0x7f80'0001, 0, 0, 2 | 64 | 256},
                    {1, 0, 0, 2 | 16 | 32 | 256}});
}

TEST_CASE("sums, products and quotients keep subnormals and round to nearest even") {
  check_cases("a + b", {{1, 1, 0, 2},
                        {f(1), f(0x1p-24f), 0, f(1)},
                        {0x3f80'0001, f(0x1p-24f), 0, 0x3f80'0002},
                        {kInf, kMinusInf, 0, kNan},
                        {kMinusZero, kMinusZero, 0, kMinusZero},
                        {kMinusZero, 0, 0, 0},
                        {0x7f7f'ffff, 0x7f7f'ffff, 0, kInf}});
  check_cases("a * b", {{f(0x1p-100f), f(0x1p-40f), 0, f(0x1p-140f)},
                        {1, f(0.5f), 0, 0},
                        {3, f(0.5f), 0, 2},
                        {0, kInf, 0, kNan},
                        {kMinusZero, f(3), 0, kMinusZero},
                        {1, f(1), 0, 1},
                        {0x0080'0000, f(0.5f), 0, 0x0040'0000}});
  check_cases("a * 1.0", {{1, 0, 0, 1}, {kMinusZero, 0, 0, kMinusZero}, {kNan, 0, 0, kNan}});
  check_cases("a + 0.0", {{kMinusZero, 0, 0, 0}, {1, 0, 0, 1}});
  check_cases("a - b",
              {{f(1), f(1), 0, 0}, {kMinusZero, 0, 0, kMinusZero}, {0x0080'0001, 0x0080'0000, 0, 1}});
  check_cases("a / b", {{f(1), 0, 0, kInf},
                        {f(1), kMinusZero, 0, kMinusInf},
                        {0, 0, 0, kNan},
                        {kInf, kInf, 0, kNan},
                        {f(1), f(3), 0, 0x3eaa'aaab},
                        {f(1), 1, 0, kInf},
                        {f(1), f(0x1p127f), 0, 0x0040'0000},
                        {2, f(4), 0, 0},
                        {6, f(4), 0, 2},
                        {f(1), kInf, 0, 0}});
  check_cases("-a", {{0, 0, 0, kMinusZero}, {kMinusZero, 0, 0, 0}, {f(1), 0, 0, f(-1)}});
}

TEST_CASE("a product and a sum round twice, fma once") {
  const uint32_t x = f(1 + 0x1p-12f), minus_square = f(-(1 + 0x1p-11f));  // x squared is 1 + 2^-11 + 2^-24
  check_cases("a * b + c", {{x, x, minus_square, 0}});
  check_cases("fma(a, b, c)",
              {{x, x, minus_square, f(0x1p-24f)}, {0, kInf, f(1), kNan}, {kInf, f(1), kMinusInf, kNan}});
  check_cases("dot(vec2(a, c), vec2(b, 1.0))", {{x, x, minus_square, 0}});
}

TEST_CASE("roots of zeros, negative numbers and infinities") {
  check_cases("sqrt(a)", {{kMinusZero, 0, 0, kMinusZero},
                          {f(-1), 0, 0, kNan},
                          {kInf, 0, 0, kInf},
                          {f(2), 0, 0, 0x3fb5'04f3},
                          {1, 0, 0, f(0x1.6a09e6p-75f)}});
  check_cases("inversesqrt(a)", {{0, 0, 0, kInf},
                                 {kMinusZero, 0, 0, kMinusInf},
                                 {kInf, 0, 0, 0},
                                 {f(-1), 0, 0, kNan},
                                 {f(4), 0, 0, f(0.5f)}});
}

TEST_CASE("powers, exponentials and logarithms at their edges") {
  check_cases("pow(a, b)", {{0, 0, 0, f(1)},
                            {f(-2), 0, 0, f(1)},
                            {kNan, kMinusZero, 0, f(1)},
                            {kInf, 0, 0, f(1)},
                            {f(-2), f(2), 0, kNan},
                            {0, f(2), 0, 0},
                            {0, f(-1), 0, kInf},
                            {f(2), f(3), 0, f(8)},
                            {f(1), kInf, 0, kNan},
                            {f(2), kMinusInf, 0, 0},
                            {kNan, f(1), 0, kNan},
                            {f(2), f(128), 0, kInf},
                            {f(2), f(-149), 0, 1}});
  check_cases("exp2(a)", {{kMinusInf, 0, 0, 0},
                          {kInf, 0, 0, kInf},
                          {kNan, 0, 0, kNan},
                          {f(-1000), 0, 0, 0},
                          {f(128), 0, 0, kInf},
                          {f(10), 0, 0, f(1024)}});
  check_cases("exp(a)", {{kMinusInf, 0, 0, 0}, {kInf, 0, 0, kInf}, {0, 0, 0, f(1)}, {kNan, 0, 0, kNan}});
  check_cases("log2(a)", {{0, 0, 0, kMinusInf},
                          {kMinusZero, 0, 0, kMinusInf},
                          {f(-1), 0, 0, kNan},
                          {kInf, 0, 0, kInf},
                          {f(1), 0, 0, 0},
                          {f(8), 0, 0, f(3)},
                          {1, 0, 0, f(-149)}});
  check_cases("log(a)", {{0, 0, 0, kMinusInf}, {f(-1), 0, 0, kNan}, {f(1), 0, 0, 0}, {kInf, 0, 0, kInf}});
}

TEST_CASE("atan of two arguments tells quadrants by signs, also of zeros and infinities") {
  check_cases("atan(a, b)", {{0, 0, 0, 0},
                             {kMinusZero, 0, 0, kMinusZero},
                             {0, kMinusZero, 0, f(kPi)},
                             {kMinusZero, kMinusZero, 0, f(-kPi)},
                             {f(1), kInf, 0, 0},
                             {f(1), kMinusInf, 0, f(kPi)},
                             {kInf, f(1), 0, f(kPi / 2)},
                             {kNan, f(1), 0, kNan},
                             {f(1), kNan, 0, kNan},
                             {f(1), 0, 0, f(kPi / 2)}});
  check_cases("abs(atan(a, b) - c) < 1e-6", {{kMinusInf, kInf, f(-kPi / 4), 1},
                                             {kInf, kMinusInf, f(kPi * 0.75f), 1},
                                             {f(-1), f(-1), f(kPi * -0.75f), 1}});
  check_cases("atan(a)", {{kInf, 0, 0, f(kPi / 2)},
                          {kMinusInf, 0, 0, f(-kPi / 2)},
                          {kMinusZero, 0, 0, kMinusZero},
                          {kNan, 0, 0, kNan}});
  check_cases("asin(a)", {{f(1), 0, 0, f(kPi / 2)},
                          {f(-1), 0, 0, f(-kPi / 2)},
                          {f(1.5f), 0, 0, kNan},
                          {kMinusZero, 0, 0, kMinusZero},
                          {kNan, 0, 0, kNan}});
  check_cases("acos(a)",
              {{f(1), 0, 0, 0}, {f(-1), 0, 0, f(kPi)}, {f(-1.5f), 0, 0, kNan}, {f(1.5f), 0, 0, kNan}});
  check_cases("sin(a)", {{kInf, 0, 0, kNan},
                         {kMinusInf, 0, 0, kNan},
                         {kNan, 0, 0, kNan},
                         {0, 0, 0, 0},
                         {kMinusZero, 0, 0, kMinusZero}});
  check_cases("cos(a)", {{kInf, 0, 0, kNan}, {kNan, 0, 0, kNan}, {0, 0, 0, f(1)}, {kMinusZero, 0, 0, f(1)}});
}

TEST_CASE("mod is x - y floor(x / y), NaN for y of zero or infinity") {
  check_cases("mod(a, b)", {{f(5.5f), 0, 0, kNan},
                            {f(-1), f(3), 0, f(2)},
                            {f(1), f(-3), 0, f(-2)},
                            {f(7), f(7), 0, 0},
                            {f(1), kInf, 0, kNan},
                            {kInf, f(1), 0, kNan},
                            {f(5.25f), f(2), 0, f(1.25f)},
                            {kNan, f(1), 0, kNan}});
  check_cases("fract(a)", {{f(-1e-10f), 0, 0, f(1)},
                           {kInf, 0, 0, kNan},
                           {kMinusZero, 0, 0, 0},
                           {f(-1.25f), 0, 0, f(0.75f)},
                           {f(2), 0, 0, 0}});
}

TEST_CASE("rounding takes ties to even and keeps the sign of zero") {
  for (const char* expression : {"round(a)", "roundEven(a)"})
    check_cases(expression, {{f(0.5f), 0, 0, 0},
                             {f(1.5f), 0, 0, f(2)},
                             {f(2.5f), 0, 0, f(2)},
                             {f(-0.5f), 0, 0, kMinusZero},
                             {f(0x1p23f + 1), 0, 0, f(0x1p23f + 1)},
                             {kInf, 0, 0, kInf},
                             {kNan, 0, 0, kNan},
                             {1, 0, 0, 0}});
  check_cases("floor(a)",
              {{f(-0x1p-149f), 0, 0, f(-1)}, {kMinusZero, 0, 0, kMinusZero}, {kMinusInf, 0, 0, kMinusInf}});
  check_cases("ceil(a)", {{1, 0, 0, f(1)}, {f(-0.5f), 0, 0, kMinusZero}, {kNan, 0, 0, kNan}});
  check_cases("trunc(a)", {{f(-0.5f), 0, 0, kMinusZero}, {f(1e20f), 0, 0, f(1e20f)}});
  check_cases("sign(a)", {{kNan, 0, 0, 0}, {kMinusZero, 0, 0, 0}, {1, 0, 0, f(1)}, {kMinusInf, 0, 0, f(-1)}});
  check_cases("abs(a)", {{kMinusZero, 0, 0, 0}, {kMinusInf, 0, 0, kInf}, {kNan, 0, 0, kNan}});
  check_cases("step(a, b)", {{f(1), f(1), 0, f(1)}, {f(1), kNan, 0, f(1)}, {f(1), f(0.5f), 0, 0}});
  check_cases("smoothstep(a, b, c)", {{f(1), f(1), f(1), 0},
                                      {f(0), f(1), kNan, 0},
                                      {f(0), f(1), f(0.5f), f(0.5f)},
                                      {f(0), f(1), f(9), f(1)}});
  check_cases("mix(a, b, c)", {{f(3), f(7), f(0), f(3)},
                               {f(3), f(7), f(1), f(7)},
                               {kInf, f(1), f(1), kNan},
                               {f(3), kNan, f(0), kNan}});
}

TEST_CASE("floats out of range become the nearest integer there is, NaN becomes 0") {
  check_cases("int(a)", {{kNan, 0, 0, 0},
                         {kInf, 0, 0, kIntMax},
                         {kMinusInf, 0, 0, kIntMin},
                         {f(0x1p31f), 0, 0, kIntMax},
                         {f(-0x1p31f), 0, 0, kIntMin},
                         {f(-3e9f), 0, 0, kIntMin},
                         {f(-0.9f), 0, 0, 0},
                         {f(-7.9f), 0, 0, uint32_t(-7)},
                         {0xffff'ffff, 0, 0, 0}});
  check_cases("uint(a)", {{kNan, 0, 0, 0},
                          {kInf, 0, 0, kOnes},
                          {kMinusInf, 0, 0, 0},
                          {f(-1), 0, 0, 0},
                          {f(-0.5f), 0, 0, 0},
                          {f(0x1p32f), 0, 0, kOnes},
                          {f(3e9f), 0, 0, 3'000'000'000u}});
  check_cases("float(i)", {{16777217, 0, 0, f(16777216)},
                           {16777219, 0, 0, f(16777220)},
                           {kIntMin, 0, 0, f(-0x1p31f)},
                           {kIntMax, 0, 0, f(0x1p31f)}});
  check_cases("float(A)",
              {{kOnes, 0, 0, f(0x1p32f)}, {0xffff'ff7f, 0, 0, 0x4f7f'ffff}, {0xffff'ff80, 0, 0, f(0x1p32f)}});
}

TEST_CASE("floats out of the range of narrow and wide integers become the nearest there is") {
  const std::string types = "#extension GL_EXT_shader_explicit_arithmetic_types : require\n";
  check_cases("int(int8_t(a))",
              {{f(300), 0, 0, 127},
               {f(-300), 0, 0, uint32_t(-128)},
               {kNan, 0, 0, 0},
               {f(-7.9f), 0, 0, uint32_t(-7)},
               {kMinusInf, 0, 0, uint32_t(-128)}},
              types);
  check_cases(
      "uint(uint8_t(a))",
      {{f(300), 0, 0, 255}, {f(-1), 0, 0, 0}, {kNan, 0, 0, 0}, {f(255.9f), 0, 0, 255}, {kInf, 0, 0, 255}},
      types);
  check_cases("int(int16_t(a))",
              {{f(1e6f), 0, 0, 32767}, {f(-1e6f), 0, 0, uint32_t(-32768)}, {kNan, 0, 0, 0}}, types);
  check_cases("uint(uint16_t(a))", {{f(1e6f), 0, 0, 65535}, {f(-1e6f), 0, 0, 0}, {kNan, 0, 0, 0}}, types);
  check_cases(
      "uint(int64_t(a) >> 32)",
      {{f(1e30f), 0, 0, kIntMax}, {f(-1e30f), 0, 0, kIntMin}, {f(-1), 0, 0, kOnes}, {f(0x1p40f), 0, 0, 256}},
      types);
  check_cases("uint(int64_t(a) >> 32)", {{kNan, 0, 0, kIntMin}}, types);
  check_cases("uint(uint64_t(a) >> 32)", {{kNan, 0, 0, kIntMin}}, types);
  check_cases("uint(uint64_t(a) >> 32)",
              {{f(1e30f), 0, 0, kOnes}, {f(-1e30f), 0, 0, 0}, {f(0x1p63f), 0, 0, 0x8000'0000}}, types);
}

TEST_CASE("halves and doubles have NaN, zeros, subnormals and limits of conversion as floats have") {
  const std::string types = "#extension GL_EXT_shader_explicit_arithmetic_types : require\n";
  const std::string half = types + "float16_t h(float x) { return float16_t(x); }\n";
  check_cases("float(min(h(a), h(b)))",
              {{kNan, f(1), 0, f(1)}, {f(1), kNan, 0, f(1)}, {0, kMinusZero, 0, kMinusZero}}, half);
  check_cases("float(max(h(a), h(b)))", {{kNan, f(1), 0, f(1)}, {0, kMinusZero, 0, 0}}, half);
  check_cases("float(h(a) * h(b))",
              {{f(0x1p-14f), f(0.5f), 0, f(0x1p-15f)},
               {f(0x1p-24f), f(0.5f), 0, 0},
               {f(60000), f(2), 0, kInf},
               {f(0x1p-24f), f(1.5f), 0, f(0x1p-23f)}},
              half);
  check_cases("float(h(a) / h(b))", {{f(1), 0, 0, kInf}, {0, 0, 0, kNan}, {f(1), f(3), 0, f(0x1.554p-2f)}},
              half);
  check_cases("h(a) == h(b)", {{kNan, kNan, 0, 0}, {0, kMinusZero, 0, 1}, {f(2049), f(2048), 0, 1}}, half);
  check_cases("float(h(a))",
              {{f(65519), 0, 0, f(65504)},
               {f(65520), 0, 0, kInf},
               {f(0x1p-25f), 0, 0, 0},
               {f(2049), 0, 0, f(2048)},
               {f(2051), 0, 0, f(2052)}},
              half);
  check_cases("float(min(double(a), double(b)))",
              {{kNan, f(1), 0, f(1)}, {f(1), kNan, 0, f(1)}, {0, kMinusZero, 0, kMinusZero}}, types);
  check_cases("float(double(a) * double(b))",
              {{f(0x1p-100f), f(0x1p-40f), 0, f(0x1p-140f)},
               {0x7f7f'ffff, f(2), 0, kInf},
               {f(0x1p-149f), f(0.5f), 0, 0}},
              types);
  check_cases("float(double(a) / double(b))",
              {{f(1), 0, 0, kInf}, {0, 0, 0, kNan}, {f(1), f(3), 0, 0x3eaa'aaab}}, types);
  check_cases("float(sqrt(double(a)))",
              {{f(-1), 0, 0, kNan}, {kMinusZero, 0, 0, kMinusZero}, {f(2), 0, 0, 0x3fb5'04f3}}, types);
  check_cases("int(double(a))",
              {{f(3e9f), 0, 0, kIntMax},
               {f(-3e9f), 0, 0, kIntMin},
               {kNan, 0, 0, kIntMin},
               {f(-7.9f), 0, 0, uint32_t(-7)}},
              types);
  check_cases("uint(double(a))", {{f(5e9f), 0, 0, kOnes}, {f(-1), 0, 0, 0}, {kNan, 0, 0, kIntMin}}, types);
  check_cases("double(a) != double(b)", {{kNan, kNan, 0, 1}, {0, kMinusZero, 0, 0}}, types);
}

TEST_CASE("ldexp rounds once, and every exponent is allowed") {
  check_cases("ldexp(a, j)", {{f(1), 128, 0, kInf},
                              {f(1), uint32_t(-149), 0, 1},
                              {f(1), uint32_t(-150), 0, 0},
                              {f(1.5f), uint32_t(-149), 0, 2},
                              {f(0.5f), 128, 0, f(0x1p127f)},
                              {1, 149, 0, f(1)},
                              {1, 277, 0, kInf},
                              {1, 276, 0, f(0x1p127f)},
                              {f(1), kIntMax, 0, kInf},
                              {f(1), kIntMin, 0, 0},
                              {f(-1), kIntMin, 0, kMinusZero},
                              {0, 1000, 0, 0},
                              {kMinusZero, 5, 0, kMinusZero},
                              {kInf, uint32_t(-1000), 0, kInf},
                              {kNan, 1, 0, kNan},
                              {0x3f80'0001, uint32_t(-127), 0, 0x0040'0000},
                              {0x3f80'0003, uint32_t(-128), 0, 0x0020'0001},
                              {0x7f7f'ffff, uint32_t(-276), 0, 2},
                              {f(3), 5, 0, f(96)}});
}

TEST_CASE("frexp and modf split zeros, subnormals and infinities") {
  const std::string split =
      "float fraction(float x) { int e; return frexp(x, e); } int power(float x) { int e; frexp(x, e); "
      "return e; }\n"
      "float part(float x) { float w; return modf(x, w); } float whole(float x) { float w; modf(x, w); "
      "return w; }\n";
  check_cases("fraction(a)",
              {{0, 0, 0, 0},
               {kMinusZero, 0, 0, kMinusZero},
               {f(1), 0, 0, f(0.5f)},
               {1, 0, 0, f(0.5f)},
               {f(-3), 0, 0, f(-0.75f)},
               {kInf, 0, 0, kInf},
               {kNan, 0, 0, kNan}},
              split);
  check_cases("power(a)",
              {{0, 0, 0, 0},
               {kMinusZero, 0, 0, 0},
               {f(1), 0, 0, 1},
               {1, 0, 0, uint32_t(-148)},
               {f(-3), 0, 0, 2},
               {0x7f7f'ffff, 0, 0, 128}},
              split);
  check_cases("part(a)",
              {{f(-1.5f), 0, 0, f(-0.5f)},
               {kMinusZero, 0, 0, kMinusZero},
               {f(-2), 0, 0, kMinusZero},
               {kInf, 0, 0, 0},
               {kMinusInf, 0, 0, kMinusZero},
               {kNan, 0, 0, kNan}},
              split);
  check_cases("whole(a)",
              {{f(-1.5f), 0, 0, f(-1)}, {f(-0.5f), 0, 0, kMinusZero}, {kInf, 0, 0, kInf}, {kNan, 0, 0, kNan}},
              split);
}

TEST_CASE("lengths and directions of zero and of huge vectors follow their formulas") {
  check_cases("normalize(vec3(a, b, c)).x", {{0, 0, 0, kNan},
                                             {f(1e-30f), 0, 0, kInf},
                                             {f(1e30f), 0, 0, 0},
                                             {f(3), f(4), 0, f(0.6f)},
                                             {kInf, 0, 0, kNan}});
  check_cases("normalize(a)", {{f(-5), 0, 0, f(-1)}, {0, 0, 0, kNan}});
  check_cases("length(vec2(a, b))",
              {{f(1e30f), 0, 0, kInf}, {f(1e-30f), 0, 0, 0}, {kNan, kInf, 0, kNan}, {f(3), f(4), 0, f(5)}});
  check_cases("length(a)", {{f(-1e30f), 0, 0, f(1e30f)}, {f(-1e-30f), 0, 0, f(1e-30f)}});
  check_cases("distance(vec2(a), vec2(b))", {{kInf, kInf, 0, kNan}, {f(1), f(1), 0, 0}});
  check_cases("refract(vec2(a, b), vec2(0.0, 1.0), c).x", {{f(1), 0, f(2), 0}, {f(0), f(-1), f(1), 0}});
  check_cases("faceforward(a, b, c)",
              {{f(3), f(1), f(0), f(-3)}, {f(3), f(1), f(-1), f(3)}, {f(3), kNan, f(1), f(-3)}});
}

TEST_CASE("packing rounds to even after clamping, and gives NaN a place") {
  check_cases("packUnorm4x8(vec4(a, b, c, 0.0))",
              {{kNan, f(2), f(-1), 0x00ff00}, {f(0.5f), f(0.00196f), kInf, 0xff'00'80}});
  check_cases("packSnorm4x8(vec4(a, b, c, 0.0))",
              {{kNan, f(2), f(-2), 0x817f7f}, {f(-0.5f), kMinusInf, 0, 0x0081c0}});
  check_cases("packHalf2x16(vec2(a, b))", {{f(65519), f(65520), 0, 0x7c00'7bff},
                                           {f(0x1p-25f), f(0x1.8p-25f), 0, 0x0001'0000},
                                           {kMinusZero, kMinusInf, 0, 0xfc00'8000}});
  check_cases("isnan(unpackHalf2x16(packHalf2x16(vec2(a, b))).x)", {{kNan, 0, 0, 1}, {f(1), 0, 0, 0}});
  check_cases("unpackSnorm2x16(A).x", {{0x8000, 0, 0, f(-1)}, {0x8001, 0, 0, f(-1)}, {0x7fff, 0, 0, f(1)}});
}

}  // namespace
}  // namespace glint::frontend::lab
