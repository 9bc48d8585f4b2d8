// Computes the colour map's path and its colours.
// SPDX-License-Identifier: Apache-2.0
#include "report/picture/colour_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace glint::report {
namespace {

struct Lab {
  double lightness, a, b;
};

// Returns a colour of the path. Choice: lightness goes from 0.20 to 0.93, hue from 285 to 100 degrees, and
// chroma along a parabola, so that greens are as strong as sRGB allows.
Lab on_path(double t) {
  constexpr double kBegin = 0.10, kMiddle = 0.06, kEnd = 0.15;
  const double chroma = kBegin * (1 - t) * (1 - t) + 2 * kMiddle * t * (1 - t) + kEnd * t * t;
  const double hue = (285 - 185 * t) * std::numbers::pi / 180;
  return {0.20 + 0.73 * t, chroma * std::cos(hue), chroma * std::sin(hue)};
}

double distance(const Lab& x, const Lab& y) {
  return std::hypot(x.lightness - y.lightness, x.a - y.a, x.b - y.b);
}

// Applies sRGB's transfer function (IEC 61966-2-1).
uint8_t encoded(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return uint8_t(std::lround(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055)));
}

// Converts with Ottosson's matrices.
ColourMap::Rgb srgb_of(const Lab& c) {
  const double l = std::pow(c.lightness + 0.3963377774 * c.a + 0.2158037573 * c.b, 3);
  const double m = std::pow(c.lightness - 0.1055613458 * c.a - 0.0638541728 * c.b, 3);
  const double s = std::pow(c.lightness - 0.0894841775 * c.a - 1.2914855480 * c.b, 3);
  return {encoded(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          encoded(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          encoded(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

}  // namespace

ColourMap::ColourMap() {
  constexpr int kFine = 4096;
  std::vector<double> along{0.0};  // length of the path up to each fine step
  for (int i = 1; i <= kFine; ++i)
    along.push_back(along.back() + distance(on_path(double(i - 1) / kFine), on_path(double(i) / kFine)));
  for (int step = 0, i = 0; step < kSteps; ++step) {
    const double wanted = along.back() * step / (kSteps - 1);
    while (i < kFine - 1 && along[size_t(i) + 1] < wanted) ++i;
    const double part = (wanted - along[size_t(i)]) / (along[size_t(i) + 1] - along[size_t(i)]);
    colours_[size_t(step)] = srgb_of(on_path((i + part) / kFine));
  }
}

const ColourMap::Rgb& ColourMap::of(double value) const {
  return colours_[size_t(std::lround(std::clamp(value, 0.0, 1.0) * (kSteps - 1)))];
}

}  // namespace glint::report
