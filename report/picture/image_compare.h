// Measures how far apart two pictures are: mean squared error, PSNR, structural similarity, and a picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::report {

// Holds three floats per pixel, with row 0 on top.
struct Picture {
  uint32_t width = 0, height = 0;  // pixels
  std::vector<float> rgb;
};

// Reads a PFM, EXR or HDR file as its floats, or another picture of 8 bits as values of 0 to 1. Throws
// UserError for other files, and for damaged ones.
Picture read_picture(const std::string& path);

// Returns the picture as PNG of 8 bits.
std::string png_of(const Picture& picture);

// Returns whether there is no distance between two pixels. Two values are the same when they are equal, when
// both are not a number, or when both are the same infinity. A pixel is beyond measure when the values of a
// channel are not the same and one of them is not finite. `pixel` counts row by row from the top.
bool is_beyond_measure(const Picture& a, const Picture& b, size_t pixel);

struct ImageDifference {
  double mse = 0;             // mean over pixels and channels
  double psnr = 0;            // dB, for a peak of 1; infinite when nothing differs
  double ssim = 0;            // similarity of luminance; 1 for equal pictures
  double largest = 0;         // largest difference of a channel in which both are finite
  uint64_t pixels_apart = 0;  // pixels in which any channel is not the same
  // This is the number of pixels beyond measure. If there are any, mse, psnr and ssim are not numbers.
  uint64_t pixels_beyond_measure = 0;
  uint64_t first_beyond_measure = 0;  // the first pixel beyond measure
  // Counts pixels that are the same in both pictures and have a channel that is not finite. They add nothing.
  uint64_t pixels_not_finite = 0;
};

// Measures pictures of one size, and throws UserError for others. SSIM follows Wang, Bovik, Sheikh,
// Simoncelli 2004: a Gaussian window of 11 by 11 pixels with sigma 1.5, K1 = 0.01, K2 = 0.03, on values
// clamped to 0 to 1; it is the mean over windows that lie in the picture. Values that are the same and not
// finite count as 0 in SSIM. For pictures smaller than a window, SSIM is not a number.
ImageDifference difference(const Picture& a, const Picture& b);

// Returns the largest channel's absolute difference as grey, with three floats per pixel and `largest` as
// white. Pixels beyond measure are magenta.
Picture difference_picture(const Picture& a, const Picture& b, double largest);
// Marks the pixels beyond measure in magenta on a picture of the same size.
void mark_beyond_measure(const Picture& a, const Picture& b, Picture& shown);

}  // namespace glint::report
