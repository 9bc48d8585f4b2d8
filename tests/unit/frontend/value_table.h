// Checks tables of operands and results to the bit. Each expression is computed in registers and folded at
// compile time.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace glint::frontend::lab {

inline constexpr uint32_t kNan = 0x7fc0'0000, kInf = 0x7f80'0000, kMinusInf = 0xff80'0000,
                          kMinusZero = 0x8000'0000;
inline constexpr uint32_t kIntMin = 0x8000'0000, kIntMax = 0x7fff'ffff, kOnes = 0xffff'ffff;
inline uint32_t f(float x) {
  return std::bit_cast<uint32_t>(x);
}

// Holds the bits of three operands and of the result. A result of kNan stands for every NaN.
struct Case {
  uint32_t a, b, c, result;
};

// Checks `expression` for each case: once with operands from memory, and once with operands that are
// specialisation constants, which the compiler can see. In the expression, a, b, c are the operands as
// floats, A, B, C as uints, and i, j, k as ints. Its value is a float, an int, a uint or a bool. `globals`
// precede the expression.
void check_cases(const std::string& expression, const std::vector<Case>& cases,
                 const std::string& globals = "");

}  // namespace glint::frontend::lab
