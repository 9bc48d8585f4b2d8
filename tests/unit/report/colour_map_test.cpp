// Tests that the colours of maps of cost are even, grow lighter, and stay distinct without red or green.
// SPDX-License-Identifier: Apache-2.0
#include "report/picture/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/catch.h"

namespace glint::report {
namespace {

double linear(uint8_t part) {
  const double c = part / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Converts back to Oklab (Ottosson 2020).
std::array<double, 3> oklab(const ColourMap::Rgb& rgb) {
  const double r = linear(rgb[0]), g = linear(rgb[1]), b = linear(rgb[2]);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

double apart(const ColourMap& map, int from, int to) {
  const auto a = oklab(map.of(from / 15.0)), b = oklab(map.of(to / 15.0));
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

TEST_CASE("equal differences of a value are equal differences of its colour") {
  const ColourMap map;
  double least = 10, most = 0;
  for (int i = 0; i < 15; ++i) {  // each covers 17 of the 255 steps
    least = std::min(least, apart(map, i, i + 1));
    most = std::max(most, apart(map, i, i + 1));
  }
  CHECK(least > 0.04);
  CHECK(most < 1.15 * least);
}

TEST_CASE("every step of the colour map is lighter than the one before") {
  const ColourMap map;
  for (int i = 1; i <= 64; ++i) CHECK(oklab(map.of(i / 64.0))[0] > oklab(map.of((i - 1) / 64.0))[0] + 0.005);
}

TEST_CASE("values outside of the scale have the colours of its ends") {
  const ColourMap map;
  CHECK(map.of(-1) == map.of(0));
  CHECK(map.of(7) == map.of(1));
  CHECK(map.of(0) != map.of(0.02));
}

}  // namespace glint::report
