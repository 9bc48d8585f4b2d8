// Takes the speckle out of an image by anisotropic diffusion (Yu and Acton, TIP 2002).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

using Image = std::vector<float>;

struct Diffusion {
  int32_t columns, rows;
  float speckle, step;
};

// Returns the squared coefficient of variation of the upper left corner, 128 pixels wide and high.
template <class Pixels>
float speckle_of(const Pixels& image, int32_t columns, int32_t rows) {
  double sum = 0, squares = 0;
  const int32_t width = std::min(columns, 128), height = std::min(rows, 128);
  for (int32_t y = 0; y < height; ++y)
    for (int32_t x = 0; x < width; ++x) {
      const double value = image[size_t(y) * columns + x];
      sum += value, squares += value * value;
    }
  const double count = double(width) * height, mean = sum / count;
  return float((squares / count - mean * mean) / (mean * mean));
}

struct Differences {
  float north, south, west, east;
};

Differences differences_at(const Image& image, const Diffusion& d, int32_t x, int32_t y) {
  const auto at = [&](int32_t column, int32_t row) {
    return image[size_t(std::clamp(row, 0, d.rows - 1)) * d.columns + std::clamp(column, 0, d.columns - 1)];
  };
  const float mine = at(x, y);
  return {at(x, y - 1) - mine, at(x, y + 1) - mine, at(x - 1, y) - mine, at(x + 1, y) - mine};
}

float coefficient_at(const Image& image, const Diffusion& d, int32_t x, int32_t y) {
  const auto [n, s, w, e] = differences_at(image, d, x, y);
  const float mine = image[size_t(y) * d.columns + x],
              gradient = (n * n + s * s + w * w + e * e) / (mine * mine), laplacian = (n + s + w + e) / mine,
              numerator = 0.5f * gradient - (1.0f / 16.0f) * (laplacian * laplacian),
              denominator = 1.0f + 0.25f * laplacian, variation = numerator / (denominator * denominator),
              excess = (variation - d.speckle) / (d.speckle * (1.0f + d.speckle));
  return std::clamp(1.0f / (1.0f + excess), 0.0f, 1.0f);
}

Image diffused(const Image& image, const Diffusion& d) {
  Image coefficients(image.size()), out(image.size());
  for (int32_t y = 0; y < d.rows; ++y)
    for (int32_t x = 0; x < d.columns; ++x)
      coefficients[size_t(y) * d.columns + x] = coefficient_at(image, d, x, y);
  for (int32_t y = 0; y < d.rows; ++y)
    for (int32_t x = 0; x < d.columns; ++x) {
      const size_t i = size_t(y) * d.columns + x;
      const auto [n, s, w, e] = differences_at(image, d, x, y);
      const float mine = coefficients[i], below = coefficients[y + 1 < d.rows ? i + d.columns : i],
                  right = coefficients[x + 1 < d.columns ? i + 1 : i];
      out[i] = image[i] + 0.25f * d.step * (mine * n + below * s + mine * w + right * e);
    }
  return out;
}

}  // namespace

void srad(Host& host, Size size) {
  const int32_t side = size == Size::Full ? 2'048 : 128;
  const size_t pixels = size_t(side) * side;
  Image image = host.random.floats(pixels, 1, 2.7f);
  const auto values = host.buffer("image", image);
  const auto part = [&](const char* name) { return host.buffer<float>(name, pixels); };
  const auto north = part("north"), south = part("south"), west = part("west"), east = part("east"),
             coefficients = part("coefficients");
  const std::vector<pipeline::BufferRange> buffers{values, north, south, west, east, coefficients};
  const std::array<uint32_t, 3> groups{groups_of(side, 16), groups_of(side, 16), 1};
  for (int i = 0; i < 2; ++i) {
    const Diffusion diffusion{side, side, speckle_of(host.view(values), side, side), 0.5f};
    host.launch("srad_gradient", groups, buffers, diffusion);
    host.launch("srad_update", groups, buffers, diffusion);
    image = diffused(image, diffusion);
    host.check("image", values, image);
  }
}

}  // namespace glint::compute
