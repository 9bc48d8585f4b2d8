// Tables of operands and results: each expression computed in registers and folded at compile time, bit by
// bit. SPDX-License-Identifier: Apache-2.0
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

// Three operands and the result, as bits. A result of kNan stands for every NaN.
struct Case {
  uint32_t a, b, c, result;
};

// Checks `expression` for each case: once with operands from memory and once with operands that are
// specialisation constants, so that the compiler sees them. In it, a, b, c are the operands as floats, A, B,
// C as uints, i, j, k as ints; its value is a float, an int, a uint or a bool. `globals` precede it.
void check_cases(const std::string& expression, const std::vector<Case>& cases,
                 const std::string& globals = "");

}  // namespace glint::frontend::lab
