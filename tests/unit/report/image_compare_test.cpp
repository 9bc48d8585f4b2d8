// Tests differences of pictures against values worked out by hand and against the definition written out.
// SPDX-License-Identifier: Apache-2.0
#include "report/picture/image_compare.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <utility>

#include "base/diagnostics.h"
#include "pictures/encode.h"
#include "tests/support/catch.h"

using namespace glint;
using report::Picture;

namespace {

Picture plain(uint32_t width, uint32_t height, float value) {
  return {width, height, std::vector<float>(size_t(width) * height * 3, value)};
}

Picture noise(uint32_t width, uint32_t height, unsigned seed) {
  std::mt19937 random(seed);
  Picture out = plain(width, height, 0);
  for (float& value : out.rgb) value = float(random() % 1000) / 999.0f;
  return out;
}

double grey(const Picture& p, size_t x, size_t y) {
  const float* c = &p.rgb[(y * p.width + x) * 3];
  return 0.2126 * double(c[0]) + 0.7152 * double(c[1]) + 0.0722 * double(c[2]);
}

// Computes Wang et al. 2004, eq. 13 to 17, window by window with the two-dimensional weights.
double ssim_as_defined(const Picture& a, const Picture& b) {
  double all = 0, weight_sum = 0;
  const auto weight = [](int x, int y) { return std::exp(-(x * x + y * y) / 4.5); };
  for (int y = -5; y <= 5; ++y)
    for (int x = -5; x <= 5; ++x) weight_sum += weight(x, y);
  size_t windows = 0;
  for (size_t cy = 5; cy + 5 < a.height; ++cy)
    for (size_t cx = 5; cx + 5 < a.width; ++cx, ++windows) {
      const auto mean = [&](auto&& value) {
        double sum = 0;
        for (int y = -5; y <= 5; ++y)
          for (int x = -5; x <= 5; ++x)
            sum += weight(x, y) / weight_sum * value(cx + size_t(x + 5) - 5, cy + size_t(y + 5) - 5);
        return sum;
      };
      const double ma = mean([&](size_t x, size_t y) { return grey(a, x, y); }),
                   mb = mean([&](size_t x, size_t y) { return grey(b, x, y); });
      const double va = mean([&](size_t x, size_t y) { return std::pow(grey(a, x, y) - ma, 2); }),
                   vb = mean([&](size_t x, size_t y) { return std::pow(grey(b, x, y) - mb, 2); });
      const double cov =
          mean([&](size_t x, size_t y) { return (grey(a, x, y) - ma) * (grey(b, x, y) - mb); });
      all += (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
    }
  return all / double(windows);
}

}  // namespace

TEST_CASE("a picture differs from itself by nothing") {
  const Picture picture = noise(16, 13, 1);

  const report::ImageDifference d = report::difference(picture, picture);

  CHECK(d.mse == 0);
  CHECK(std::isinf(d.psnr));
  CHECK(d.ssim == Approx(1).margin(1e-12));
  CHECK(d.pixels_apart == 0);
}

TEST_CASE("one channel of one pixel that is 0.5 off gives the error worked out by hand") {
  Picture a = plain(20, 12, 0.25f), b = a;
  b.rgb[3 * 7 + 1] = 0.75f;

  const report::ImageDifference d = report::difference(a, b);

  CHECK(d.mse == Approx(0.25 / 720).epsilon(1e-12));
  CHECK(d.psnr == Approx(10 * std::log10(720 / 0.25)).epsilon(1e-12));
  CHECK(d.pixels_apart == 1);
  CHECK(d.largest == 0.5);
  const Picture shown = report::difference_picture(a, b, d.largest);
  CHECK(shown.rgb[3 * 7] == 1.0f);
  CHECK(shown.rgb[3 * 8] == 0.0f);
}

TEST_CASE(
    "what is not finite in one picture only is apart and leaves no measure, and what is the same in both "
    "adds nothing") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  const Picture black = plain(12, 11, 0);
  Picture broken = black;
  broken.rgb[3 * 5] = kNan;
  broken.rgb[3 * 7 + 2] = kInf;
  broken.rgb[3 * 9 + 1] = 0.5f;
  for (const auto& [a, b] : {std::pair{black, broken}, std::pair{broken, black}}) {
    const report::ImageDifference d = report::difference(a, b);
    CHECK(d.pixels_apart == 3);
    CHECK(d.pixels_beyond_measure == 2);
    CHECK(d.first_beyond_measure == 5);
    CHECK(d.largest == 0.5);
    for (const double measure : {d.mse, d.psnr, d.ssim}) CHECK(std::isnan(measure));
    const Picture shown = report::difference_picture(a, b, d.largest);
    CHECK(std::vector(shown.rgb.begin() + 15, shown.rgb.begin() + 18) == std::vector{1.0f, 0.0f, 1.0f});
    CHECK(shown.rgb[3 * 9] == 1.0f);
  }
  const report::ImageDifference same = report::difference(broken, broken);
  CHECK(same.pixels_apart == 0);
  CHECK(same.pixels_beyond_measure == 0);
  CHECK(same.pixels_not_finite == 2);
  CHECK(std::isinf(same.psnr));
  CHECK(same.ssim == Approx(1).margin(1e-12));
  Picture other = broken;
  other.rgb[3 * 7 + 2] = -kInf;
  CHECK(report::difference(broken, other).pixels_beyond_measure == 1);
}

TEST_CASE("structural similarity is that of the paper's definition") {
  const Picture a = noise(19, 14, 2);
  Picture b = noise(19, 14, 3);
  for (size_t i = 0; i < b.rgb.size(); ++i) b.rgb[i] = 0.7f * a.rgb[i] + 0.3f * b.rgb[i];

  CHECK(report::difference(a, b).ssim == Approx(ssim_as_defined(a, b)).epsilon(1e-9));
  CHECK(report::difference(a, b).ssim < 0.99);
  CHECK(report::difference(plain(11, 11, 0.2f), plain(11, 11, 0.6f)).ssim ==
        Approx((2 * 0.12 + 1e-4) / (0.04 + 0.36 + 1e-4)).epsilon(1e-6));
  CHECK(std::isnan(report::difference(plain(10, 11, 0), plain(10, 11, 1)).ssim));
}

TEST_CASE("pictures of two sizes are refused, and so are damaged files") {
  CHECK_THROWS_AS(report::difference(plain(2, 3, 0), plain(3, 2, 0)), UserError);
  const std::string path = (std::filesystem::temp_directory_path() / "glint_image_compare_test.pfm").string();
  std::ofstream(path, std::ios::binary) << "PF\n4 4\n-1.0\nshort";
  CHECK_THROWS_AS(report::read_picture(path), UserError);
  std::ofstream(path, std::ios::binary) << "not a picture";
  CHECK_THROWS_AS(report::read_picture(path), UserError);
  std::filesystem::remove(path);
}

TEST_CASE("what a run writes as PFM and PNG reads back as it was") {
  const std::vector<float> rgba = {0,    0.5f, 1,    1, 0.25f, 2.5f, -1,   1,
                                   0.1f, 0.2f, 0.3f, 1, 0.4f,  0.6f, 0.8f, 1};
  const pictures::ImageView view{2, 2, rgba};
  const std::string base = (std::filesystem::temp_directory_path() / "glint_image_compare_test").string();
  std::ofstream(base + ".pfm", std::ios::binary) << pictures::pfm_bytes(view);
  std::ofstream(base + ".png", std::ios::binary) << pictures::png_bytes(view);

  const Picture floats = report::read_picture(base + ".pfm"), bytes = report::read_picture(base + ".png");

  for (size_t i = 0; i < 12; ++i) {
    const float value = rgba[i / 3 * 4 + i % 3];
    CHECK(floats.rgb[i] == value);
    CHECK(bytes.rgb[i] == Approx(std::min(1.0f, std::max(0.0f, value))).margin(0.5 / 255 + 1e-6));
  }
  std::filesystem::remove(base + ".pfm");
  std::filesystem::remove(base + ".png");
}
