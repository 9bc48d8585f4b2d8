// Encodes a rendered image as PNG (8 bits, for eyes) and as PFM (floats, for comparing). exr.h encodes EXR.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace glint::pictures {

// Holds display-referred values, with row 0 on top and four floats per pixel. PNG and PFM have no alpha.
struct ImageView {
  uint32_t width = 0, height = 0;  // pixels
  std::span<const float> rgba;     // width * height * 4
};

// Each function works on up to `threads` threads of the host, which do not show in the bytes.

// Returns three channels of 8 bits: round(255 * clamp(value, 0, 1)). A value that is not a number becomes 0.
std::string png_bytes(const ImageView& image, uint32_t threads = 1);

// Returns "PF" and three little-endian floats per pixel, with the bottom row first. Values are not clamped.
std::string pfm_bytes(const ImageView& image, uint32_t threads = 1);

}  // namespace glint::pictures
