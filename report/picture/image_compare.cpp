// Measures differences between pictures.
// SPDX-License-Identifier: Apache-2.0
#include "report/picture/image_compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/diagnostics.h"

namespace glint::report {
namespace {

constexpr size_t kWindow = 11;  // pixels (Wang et al. 2004, sec. III-B, like the numbers below)
constexpr double kSigma = 1.5;  // pixels
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;  // (K1 L)^2 and (K2 L)^2 with L = 1

double known(float value) {
  return std::isfinite(value) ? double(value) : 0.0;
}

// Says how the three channels from `first` on differ.
struct PixelPair {
  bool is_same = true, is_beyond_measure = false, is_finite = true;
  // These are the sum of the squares of the differences between finite values, and the largest difference.
  double squares = 0, largest = 0;
};

PixelPair pair_of(const Picture& a, const Picture& b, size_t first) {
  PixelPair out;
  for (size_t c = first; c < first + 3; ++c) {
    const float x = a.rgb[c], y = b.rgb[c];
    const bool is_same = x == y || (std::isnan(x) && std::isnan(y)),
               is_finite = std::isfinite(x) && std::isfinite(y);
    out.is_same &= is_same;
    out.is_finite &= is_finite;
    out.is_beyond_measure |= !is_same && !is_finite;
    if (!is_finite) continue;
    const double apart = std::abs(double(x) - double(y));
    out.squares += apart * apart;
    out.largest = std::max(out.largest, apart);
  }
  return out;
}

void check_sizes(const Picture& a, const Picture& b) {
  if (a.width == b.width && a.height == b.height) return;
  throw UserError({}, fmt::format("pictures of {}x{} and {}x{} pixels cannot be compared", a.width, a.height,
                                  b.width, b.height));
}

// Returns the luminance with the weights of ITU-R BT.709.
std::vector<double> luminance(const Picture& picture) {
  std::vector<double> out(size_t(picture.width) * picture.height);
  const auto channel = [&](size_t i) { return std::clamp(known(picture.rgb[i]), 0.0, 1.0); };
  for (size_t i = 0; i < out.size(); ++i)
    out[i] = 0.2126 * channel(3 * i) + 0.7152 * channel(3 * i + 1) + 0.0722 * channel(3 * i + 2);
  return out;
}

std::array<double, kWindow> gaussian() {
  std::array<double, kWindow> out{};
  double sum = 0;
  for (size_t i = 0; i < kWindow; ++i) {
    const double x = double(i) - double(kWindow / 2);
    sum += out[i] = std::exp(-x * x / (2 * kSigma * kSigma));
  }
  for (double& weight : out) weight /= sum;
  return out;
}

// Returns the weighted means of every window that lies in the plane: along rows, then along columns.
std::vector<double> blurred(const std::vector<double>& plane, size_t width, size_t height) {
  static const std::array<double, kWindow> kWeights = gaussian();
  const size_t w = width - kWindow + 1, h = height - kWindow + 1;
  std::vector<double> rows(w * height), out(w * h);
  for (size_t y = 0; y < height; ++y)
    for (size_t x = 0; x < w; ++x)
      for (size_t k = 0; k < kWindow; ++k) rows[y * w + x] += kWeights[k] * plane[y * width + x + k];
  for (size_t y = 0; y < h; ++y)
    for (size_t x = 0; x < w; ++x)
      for (size_t k = 0; k < kWindow; ++k) out[y * w + x] += kWeights[k] * rows[(y + k) * w + x];
  return out;
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  std::transform(a.begin(), a.end(), b.begin(), out.begin(), std::multiplies<>());
  return out;
}

double ssim(const Picture& a, const Picture& b) {
  if (a.width < kWindow || a.height < kWindow) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> x = luminance(a), y = luminance(b);
  const auto mean = [&](const std::vector<double>& plane) { return blurred(plane, a.width, a.height); };
  const std::vector<double> mx = mean(x), my = mean(y), xx = mean(product(x, x)), yy = mean(product(y, y)),
                            xy = mean(product(x, y));
  double sum = 0;
  for (size_t i = 0; i < mx.size(); ++i) {
    const double vx = xx[i] - mx[i] * mx[i], vy = yy[i] - my[i] * my[i], covariance = xy[i] - mx[i] * my[i];
    sum += (2 * mx[i] * my[i] + kC1) * (2 * covariance + kC2) /
           ((mx[i] * mx[i] + my[i] * my[i] + kC1) * (vx + vy + kC2));
  }
  return sum / double(mx.size());
}

}  // namespace

bool is_beyond_measure(const Picture& a, const Picture& b, size_t pixel) {
  return pair_of(a, b, 3 * pixel).is_beyond_measure;
}

ImageDifference difference(const Picture& a, const Picture& b) {
  check_sizes(a, b);
  ImageDifference out;
  double sum = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    const PixelPair pixel = pair_of(a, b, i);
    sum += pixel.squares;
    out.pixels_apart += !pixel.is_same;
    out.pixels_not_finite += pixel.is_same && !pixel.is_finite;
    if (pixel.is_beyond_measure && out.pixels_beyond_measure++ == 0) out.first_beyond_measure = i / 3;
    out.largest = std::max(out.largest, pixel.largest);
  }
  if (out.pixels_beyond_measure > 0) {
    out.mse = out.psnr = out.ssim = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  out.mse = a.rgb.empty() ? 0 : sum / double(a.rgb.size());
  out.psnr = out.mse > 0 ? -10 * std::log10(out.mse) : std::numeric_limits<double>::infinity();
  out.ssim = ssim(a, b);
  return out;
}

Picture difference_picture(const Picture& a, const Picture& b, double largest) {
  check_sizes(a, b);
  Picture out{a.width, a.height, std::vector<float>(a.rgb.size())};
  for (size_t i = 0; i < a.rgb.size(); i += 3)
    std::fill_n(out.rgb.begin() + ptrdiff_t(i), 3,
                largest > 0 ? float(pair_of(a, b, i).largest / largest) : 0.0f);
  mark_beyond_measure(a, b, out);
  return out;
}

void mark_beyond_measure(const Picture& a, const Picture& b, Picture& shown) {
  constexpr float kMagenta[] = {1, 0, 1};
  for (size_t i = 0; i < a.rgb.size(); i += 3)
    if (is_beyond_measure(a, b, i / 3)) std::copy_n(kMagenta, 3, shown.rgb.begin() + ptrdiff_t(i));
}

}  // namespace glint::report
