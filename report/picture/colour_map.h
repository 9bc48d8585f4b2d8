// Colours for magnitudes: from dark blue to light yellow in even steps, for every kind of colour vision.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace glint::report {

// A path through Oklab (B. Ottosson, "A perceptual color space for image processing", 2020) along which each
// of 256 steps is of equal length, so that equal differences look equal. It grows lighter all the way, so
// that it reads without hues too, and runs from blue to yellow, which red-green colour blindness leaves
// apart.
class ColourMap {
 public:
  using Rgb = std::array<uint8_t, 3>;  // sRGB
  ColourMap();
  // Of value in [0, 1]; outside of it the nearer end.
  const Rgb& of(double value) const;
  static constexpr int kSteps = 256;

 private:
  std::array<Rgb, kSteps> colours_;
};

}  // namespace glint::report
