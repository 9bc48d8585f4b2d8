// How far apart two pictures are: mean squared error, PSNR, structural similarity, and a picture of the difference.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::report {

// Row 0 on top, three floats a pixel.
struct Picture {
  uint32_t width = 0, height = 0;  // pixels
  std::vector<float> rgb;
};

// A PFM of three channels, or a PNG of 8 bits as values of 0 to 1. UserError when it is neither.
Picture read_picture(const std::string& path);

struct ImageDifference {
  double mse = 0;            // mean over pixels and channels
  double psnr = 0;           // dB, for a peak of 1; infinite when nothing differs
  double ssim = 0;           // of luminance; 1: the same
  double largest = 0;        // of any channel
  uint64_t pixels_apart = 0; // in which any channel differs
};

// Of pictures of one size; UserError otherwise. Values that are not finite count as 0 in both.
// SSIM as Wang, Bovik, Sheikh, Simoncelli 2004: Gaussian window of 11 by 11 pixels with sigma 1.5, K1 = 0.01, K2 = 0.03, on values
// clamped to 0..1; the mean over windows that lie in the picture. Of pictures smaller than a window it is not a number.
ImageDifference difference(const Picture& a, const Picture& b);

// The largest channel's absolute difference as grey, three floats a pixel, with `largest` as white.
Picture difference_picture(const Picture& a, const Picture& b, double largest);

}  // namespace glint::report
