// Computes a texture's colour at a point by the Vulkan specification's formulas in scalar code.
// SPDX-License-Identifier: Apache-2.0
#include "tests/reference/texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glint::reference {
namespace {

// Holds the two texels of an axis around coordinate x, and the weight of the second.
struct Pair {
  uint32_t texel[2];
  float weight;
};

Pair neighbours(float x, uint32_t size, bool repeat) {
  const double n = double(size);
  double place = double(x) * n - 0.5;
  if (!std::isfinite(place)) place = 0;
  double low = std::floor(place);
  Pair out;
  out.weight = float(place - low);
  for (uint32_t& texel : out.texel) {
    const double inside = repeat ? low - n * std::floor(low / n) : std::clamp(low, 0.0, n - 1);
    texel = uint32_t(inside);
    low += 1;
  }
  return out;
}

// Converts by IEC 61966-2-1.
float linear(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

scenes::Vec4 texel(const scenes::Texture& texture, uint32_t x, uint32_t y) {
  const uint8_t* bytes = &texture.rgba[4 * (size_t(y) * texture.width + x)];
  scenes::Vec4 out;
  for (size_t c = 0; c < 4; ++c) {
    out[c] = float(bytes[c]) / 255.0f;
    if (texture.srgb && c < 3) out[c] = linear(out[c]);
  }
  return out;
}

}  // namespace

scenes::Vec4 sample(const scenes::Texture& texture, float u, float v) {
  const Pair x = neighbours(u, texture.width, texture.repeat),
             y = neighbours(v, texture.height, texture.repeat);
  scenes::Vec4 sum{};
  for (size_t j = 0; j < 2; ++j)
    for (size_t i = 0; i < 2; ++i) {
      const float weight = (i ? x.weight : 1 - x.weight) * (j ? y.weight : 1 - y.weight);
      const scenes::Vec4 color = texel(texture, x.texel[i], y.texel[j]);
      for (size_t c = 0; c < 4; ++c) sum[c] += weight * color[c];
    }
  return sum;
}

}  // namespace glint::reference
