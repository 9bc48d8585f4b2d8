// Tests integer arithmetic where it surprises: division by zero, the lowest number, shifts past the width,
// bit fields.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/unit/frontend/value_table.h"

namespace glint::frontend::lab {
namespace {

constexpr uint32_t u(int32_t x) {
  return uint32_t(x);
}
const std::string kTypes = "#extension GL_EXT_shader_explicit_arithmetic_types : require\n";
// Makes 64-bit integers from two words and takes the halves of the result.
const std::string kWide = kTypes +
                          "uint64_t w(uint high, uint low) { return uint64_t(high) << 32 | low; }\n"
                          "uint low(uint64_t x) { return uint(x); } uint low(int64_t x) { return uint(x); }\n"
                          "uint high(uint64_t x) { return uint(x >> 32); } uint high(int64_t x) { return "
                          "uint(uint64_t(x) >> 32); }\n";

TEST_CASE("quotients and remainders by zero are all ones; the lowest number by -1 is itself") {
  check_cases("A / B", {{7, 0, 0, kOnes}, {0, 0, 0, kOnes}, {kOnes, 2, 0, kIntMax}, {7, 1, 0, 7}});
  check_cases("A % B", {{7, 0, 0, kOnes}, {0, 0, 0, kOnes}, {kOnes, 16, 0, 15}});
  check_cases("i / j", {{7, 0, 0, kOnes},
                        {u(-7), 0, 0, kOnes},
                        {kIntMin, kOnes, 0, kIntMin},
                        {u(-7), 2, 0, u(-3)},
                        {7, u(-2), 0, u(-3)}});
  check_cases("i % j", {{7, 0, 0, kOnes},
                        {u(-7), 0, 0, kOnes},
                        {kIntMin, kOnes, 0, 0},
                        {u(-7), 3, 0, 2},
                        {7, u(-3), 0, u(-2)},
                        {u(-7), u(-3), 0, u(-1)},
                        {u(-6), 3, 0, 0}});
}

TEST_CASE("division of 8 and 16 bits follows that of 32") {
  check_cases("int(int8_t(i) / int8_t(j))",
              {{7, 0, 0, kOnes}, {u(-128), kOnes, 0, u(-128)}, {u(-7), 2, 0, u(-3)}}, kTypes);
  check_cases("int(int8_t(i) % int8_t(j))",
              {{7, 0, 0, kOnes}, {u(-7), 0, 0, kOnes}, {u(-128), kOnes, 0, 0}, {u(-7), 3, 0, 2}}, kTypes);
  check_cases("uint(uint8_t(A) / uint8_t(B))", {{7, 0, 0, 255}, {255, 2, 0, 127}}, kTypes);
  check_cases("uint(uint8_t(A) % uint8_t(B))", {{7, 0, 0, 255}, {255, 16, 0, 15}}, kTypes);
  check_cases("int(int16_t(i) / int16_t(j))", {{7, 0, 0, kOnes}, {u(-32768), kOnes, 0, u(-32768)}}, kTypes);
  check_cases("int(int16_t(i) % int16_t(j))", {{u(-7), 0, 0, kOnes}, {u(-7), 3, 0, 2}}, kTypes);
  check_cases("uint(uint16_t(A) / uint16_t(B))", {{7, 0, 0, 65535}}, kTypes);
}

TEST_CASE("division of 64 bits follows that of 32") {
  check_cases("high(w(A, B) / w(C, C))", {{7, 9, 0, kOnes}, {4, 2, 1, 0}}, kWide);
  check_cases("low(w(A, B) % w(C, C))", {{7, 9, 0, kOnes}}, kWide);
  check_cases("high(int64_t(w(A, B)) / int64_t(i - i + k))",
              {{kIntMin, 0, kOnes, kIntMin}, {7, 9, 0, kOnes}, {kOnes, u(-9), 2, kOnes}}, kWide);
  check_cases("low(int64_t(w(A, B)) / int64_t(k))",
              {{kIntMin, 0, kOnes, 0}, {7, 9, 0, kOnes}, {kOnes, u(-9), 2, u(-4)}}, kWide);
  check_cases("low(int64_t(w(A, B)) % int64_t(k))",
              {{kIntMin, 0, kOnes, 0}, {7, 9, 0, kOnes}, {kOnes, u(-7), 3, 2}, {0, 7, u(-3), u(-2)}}, kWide);
}

TEST_CASE("products, sums and negation wrap, abs of the lowest number is itself") {
  check_cases("-i", {{kIntMin, 0, 0, kIntMin}});
  check_cases("abs(i)", {{kIntMin, 0, 0, kIntMin}, {u(-5), 0, 0, 5}});
  check_cases("i * j", {{kIntMin, kOnes, 0, kIntMin}, {65536, 65536, 0, 0}});
  check_cases("i + j", {{kIntMax, 1, 0, kIntMin}});
  check_cases("sign(i)", {{kIntMin, 0, 0, kOnes}, {0, 0, 0, 0}, {9, 0, 0, 1}});
  check_cases("clamp(i, j, k)", {{5, 9, 3, 3}, {u(-5), 9, 3, 3}, {kIntMin, u(-2), 3, u(-2)}});
  check_cases("clamp(A, B, C)", {{5, 9, 3, 3}, {kOnes, 2, 3, 3}});
}

TEST_CASE("shifts past the width give 0 or copies of the sign") {
  check_cases(
      "A << B",
      {{1, 31, 0, kIntMin}, {kOnes, 32, 0, 0}, {kOnes, 33, 0, 0}, {kOnes, kOnes, 0, 0}, {kOnes, 256, 0, 0}});
  check_cases("A >> B", {{kIntMin, 31, 0, 1}, {kOnes, 32, 0, 0}, {kOnes, kIntMin, 0, 0}});
  check_cases(
      "i >> j",
      {{kIntMin, 31, 0, kOnes}, {kIntMin, 32, 0, kOnes}, {kIntMax, 40, 0, 0}, {u(-9), kOnes, 0, kOnes}});
  check_cases("i >> B", {{u(-8), 1, 0, u(-4)}, {u(-8), 99, 0, kOnes}});
  check_cases("i << j", {{5, 32, 0, 0}, {5, kOnes, 0, 0}});
  check_cases("uint(uint8_t(A) << uint8_t(B))", {{255, 4, 0, 240}, {255, 8, 0, 0}, {255, 40, 0, 0}}, kTypes);
  check_cases("int(int8_t(i) >> int8_t(j))",
              {{u(-128), 7, 0, kOnes}, {u(-128), 8, 0, kOnes}, {u(-128), kOnes, 0, kOnes}, {127, 9, 0, 0}},
              kTypes);
  check_cases("uint(uint16_t(A) >> uint16_t(B))",
              {{65535, 15, 0, 1}, {65535, 16, 0, 0}, {65535, 65535, 0, 0}}, kTypes);
  check_cases("high(w(A, B) << C)", {{1, 1, 63, kIntMin}, {1, 1, 64, 0}, {1, 1, kOnes, 0}}, kWide);
  check_cases(
      "low(int64_t(w(A, B)) >> k)",
      {{kIntMin, 0, 63, kOnes}, {kIntMin, 0, 64, kOnes}, {kIntMax, 0, 64, 0}, {kIntMin, 0, kOnes, kOnes}},
      kWide);
}

TEST_CASE("a shift by 64 bits looks at all of them") {
  check_cases("low(w(A, B) >> w(C, 0))", {{1, 2, 0, 2}, {1, 2, 1, 0}}, kWide);
  check_cases("low(int64_t(w(A, B)) >> w(C, 1))", {{kIntMin, 0, 1, kOnes}, {kIntMin, 2, 0, 1}}, kWide);
  check_cases("A << w(C, B)", {{3, 1, 0, 6}, {3, 1, 1, 0}}, kWide);
}

TEST_CASE("bit fields that reach beyond bit 31 are cut there") {
  check_cases("bitfieldExtract(A, j, k)", {{kOnes, 24, 16, 0xff},
                                           {kOnes, 32, 4, 0},
                                           {kOnes, 0, 32, kOnes},
                                           {kOnes, 5, 0, 0},
                                           {0xdead'beef, 31, 1, 1},
                                           {kOnes, 0, 99, kOnes},
                                           {kOnes, 256, 8, 0xff}});
  check_cases("bitfieldExtract(i, j, k)", {{kIntMin, 24, 16, u(-128)},
                                           {kIntMin, 40, 4, kOnes},
                                           {kIntMax, 40, 4, 0},
                                           {kOnes, 5, 0, 0},
                                           {8, 3, 1, kOnes}});
  check_cases("bitfieldInsert(A, 0xffffffffu, j, k)",
              {{0, 24, 16, 0xff00'0000}, {7, 32, 4, 7}, {0, 0, 32, kOnes}, {7, 5, 0, 7}, {0, 0, 99, kOnes}});
}

TEST_CASE("the first bit of no bits is -1") {
  check_cases("findLSB(A)", {{0, 0, 0, kOnes}, {kIntMin, 0, 0, 31}, {6, 0, 0, 1}});
  check_cases("findMSB(A)", {{0, 0, 0, kOnes}, {1, 0, 0, 0}, {kOnes, 0, 0, 31}});
  check_cases(
      "findMSB(i)",
      {{0, 0, 0, kOnes}, {kOnes, 0, 0, kOnes}, {u(-2), 0, 0, 0}, {kIntMin, 0, 0, 30}, {kIntMax, 0, 0, 30}});
  check_cases("bitCount(A) + bitfieldReverse(int(A))", {{1, 0, 0, kIntMin + 1}, {0, 0, 0, 0}});
}

TEST_CASE("carries, borrows and long products have all their bits") {
  const std::string both =
      "uint carry(uint a, uint b) { uint c; uaddCarry(a, b, c); return c; } uint borrow(uint a, uint b) { "
      "uint c; usubBorrow(a, b, c); return c; }\n"
      "int top(int a, int b) { int h, l; imulExtended(a, b, h, l); return h; } uint top(uint a, uint b) { "
      "uint h, l; umulExtended(a, b, h, l); return h; }\n";
  check_cases("carry(A, B)", {{kOnes, 1, 0, 1}, {kOnes, 0, 0, 0}, {kIntMin, kIntMin, 0, 1}}, both);
  check_cases("borrow(A, B)", {{0, 1, 0, 1}, {1, 1, 0, 0}}, both);
  check_cases("top(i, j)", {{kIntMin, kIntMin, 0, 0x4000'0000}, {kIntMin, 1, 0, kOnes}, {kOnes, kOnes, 0, 0}},
              both);
  check_cases("top(A, B)", {{kOnes, kOnes, 0, 0xffff'fffe}}, both);
}

}  // namespace
}  // namespace glint::frontend::lab
