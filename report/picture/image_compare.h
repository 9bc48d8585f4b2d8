// How far apart two pictures are: mean squared error, PSNR, structural similarity, and a picture of the
// difference.
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

// Values are the same when they are equal, both not a number, or the same infinity. A pixel is beyond measure
// where those of a channel are not the same and one is not finite: there is no distance between them. `pixel`
// counts row by row from the top.
bool is_beyond_measure(const Picture& a, const Picture& b, size_t pixel);

struct ImageDifference {
  double mse = 0;                      // mean over pixels and channels
  double psnr = 0;                     // dB, for a peak of 1; infinite when nothing differs
  double ssim = 0;                     // of luminance; 1: the same
  double largest = 0;                  // of any channel, where both are finite
  uint64_t pixels_apart = 0;           // in which any channel is not the same
  uint64_t pixels_beyond_measure = 0;  // of these; where there is one, mse, psnr and ssim are not numbers
  uint64_t first_beyond_measure = 0;   // the first of them
  uint64_t pixels_not_finite =
      0;  // the same in both pictures, with a channel that is not finite: it adds nothing
};

// Of pictures of one size; UserError otherwise. Values that are the same and not finite count as 0 in SSIM.
// SSIM as Wang, Bovik, Sheikh, Simoncelli 2004: Gaussian window of 11 by 11 pixels with sigma 1.5, K1 = 0.01,
// K2 = 0.03, on values clamped to 0..1; the mean over windows that lie in the picture. Of pictures smaller
// than a window it is not a number.
ImageDifference difference(const Picture& a, const Picture& b);

// The largest channel's absolute difference as grey, three floats a pixel, with `largest` as white; magenta
// where it is beyond measure.
Picture difference_picture(const Picture& a, const Picture& b, double largest);
// In magenta what is beyond measure, on a picture of theirs.
void mark_beyond_measure(const Picture& a, const Picture& b, Picture& shown);

}  // namespace glint::report
