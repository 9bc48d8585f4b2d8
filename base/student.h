// Gives the quantiles of Student's t distribution, for intervals of means of few values.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <iterator>

namespace glint {

// Returns the quantile of Student's t distribution that leaves 2.5 % above it.
inline double student_quantile(uint32_t degrees) {
  // Few degrees are in a table; beyond, the expansion by Cornish and Fisher (1937) has four digits.
  constexpr double kTable[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262};
  if (degrees == 0) return kTable[0];
  if (degrees <= std::size(kTable)) return kTable[degrees - 1];
  const double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z, n = degrees;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

}  // namespace glint
