// A rendered image as the bytes of a PNG (8 bits, for eyes) and of a PFM (floats, for comparing).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace glint::report {

// Display-referred values, row 0 on top, four floats a pixel; alpha is not written.
struct ImageView {
  uint32_t width = 0, height = 0;  // pixels
  std::span<const float> rgba;     // width * height * 4
};

// Three channels of 8 bits: round(255 * clamp(value, 0, 1)); not-a-number becomes 0.
std::string png_bytes(const ImageView& image);

// "PF", three little-endian floats a pixel, bottom row first: values as they are, nothing clamped.
std::string pfm_bytes(const ImageView& image);

}  // namespace glint::report
