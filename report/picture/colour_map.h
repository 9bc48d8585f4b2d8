// Gives colours for magnitudes: from dark blue to light yellow in even steps, for every kind of colour
// vision.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace glint::report {

// Holds a path through Oklab (B. Ottosson, "A perceptual color space for image processing", 2020) on which
// each of 256 steps has equal length, so that equal differences look equal. It grows lighter all the way, so
// that it can be read without hues, and runs from blue to yellow, which stay distinct in red-green colour
// blindness.
class ColourMap {
 public:
  using Rgb = std::array<uint8_t, 3>;  // sRGB
  ColourMap();
  // Returns the colour of a value in [0, 1]. Values outside get the colour of the nearer end.
  const Rgb& of(double value) const;
  static constexpr int kSteps = 256;

 private:
  std::array<Rgb, kSteps> colours_;
};

}  // namespace glint::report
