// Paints textures: stone, bricks, planks, panels, cloth, bark, lacquer and leaves.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/paintings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <vector>

#include "base/parallel_ranges.h"
#include "scenes/generate/distance_field.h"
#include "scenes/generate/solids.h"

namespace glint::scenes {
namespace {

constexpr uint32_t kTile = 4;  // texels along a side that share a value of smooth noise

uint8_t unorm(float value) {
  return uint8_t(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f);
}

// Returns which of kGrains the texel has.
constexpr uint32_t kGrains = 256;
uint32_t grain(uint32_t x, uint32_t y, uint32_t seed) {
  uint32_t h = x * 0x8da6b343u ^ y * 0xd8163841u ^ seed * 0xcb1ab31fu;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  return (h ^ h >> 13) % kGrains;
}

// Returns the brightness of a grain.
float brightness(uint32_t grain) {
  return 0.92f + 0.08f * (float(grain) / (kGrains - 1));
}

using Texel = std::array<uint8_t, 4>;
Texel texel_of(const Vec3& color, float light) {
  return {unorm(color[0] * light), unorm(color[1] * light), unorm(color[2] * light), 255};
}

// Returns the brightness of a wall of `rows` rows of bricks, in which every other row is moved by half a
// brick. The mortar in the joints is darker.
float brick(float u, float v, float rows, float joint) {
  const float row = std::floor(v * rows);
  const float x = u * rows * 0.5f + (int(row) % 2 ? 0.5f : 0.0f), y = v * rows - row;
  const float across = x - std::floor(x);
  return std::min({across * 2, (1 - across) * 2, y, 1 - y}) < joint ? 0.55f : 1.0f;
}

float shade(Pattern pattern, float u, float v) {
  switch (pattern) {
    case Pattern::Stone:
    case Pattern::Lacquer:
      return 1;
    case Pattern::Bricks:
      return brick(u, v, 16, 0.06f);
    case Pattern::Planks:
      return brick(v, u, 8, 0.03f) * (0.9f + 0.1f * wave(u * 60));
    case Pattern::Panels:
      return brick(u, v, 4, 0.02f);
    case Pattern::Stripes:
      return 0.75f + 0.25f * wave(u * 10);
    case Pattern::Bark:
      return 0.65f + 0.35f * wave(u * 14 + 0.4f * wave(v * 5));
  }
  return 1;
}

// Returns the depth of a point in the nearest leaflet; it is 0 or less outside of all leaflets. `u` and `v`
// are in [0, 1], and the stem is at the bottom.
float leaf_depth(float u, float v) {
  constexpr Vec2 kAxes[5] = {{0, 1}, {0.6f, 0.8f}, {-0.6f, 0.8f}, {0.96f, 0.28f}, {-0.96f, 0.28f}};
  const float x = u - 0.5f, y = 0.75f - v;
  float depth = std::abs(x) < 0.012f && y < 0 ? 0.2f : -1;  // the stem
  for (const Vec2& axis : kAxes) {
    const float along = x * axis[0] + y * axis[1], across = std::abs(x * axis[1] - y * axis[0]);
    const float t = along / 0.48f;
    if (t > 0 && t < 1) depth = std::max(depth, 1 - across / (0.55f * t * t * (1 - t) + 0.004f));
  }
  return depth;
}

// Writes texel_at(x, y) to each texel of rows `begin` to `end`.
template <class TexelAt>
void paint_rows(Texture& texture, uint32_t begin, uint32_t end, const TexelAt& texel_at) {
  uint8_t* out = &texture.rgba[4 * size_t(begin) * texture.width];
  for (uint32_t y = begin; y < end; ++y)
    for (uint32_t x = 0; x < texture.width; ++x, out += sizeof(Texel)) {
      const Texel texel = texel_at(x, y);
      std::memcpy(out, texel.data(), sizeof texel);
    }
}

// Paints rows `begin` to `end` of a texture with lacquer, which has grains alone.
void paint_lacquer(Texture& texture, uint32_t begin, uint32_t end, const Vec3& color, uint32_t seed) {
  std::array<Texel, kGrains> texels;
  for (uint32_t i = 0; i < kGrains; ++i) texels[i] = texel_of(color, brightness(i));
  paint_rows(texture, begin, end, [&](uint32_t x, uint32_t y) { return texels[grain(x, y, seed)]; });
}

// Paints rows `begin` to `end` of a texture, which share their smooth noise.
void paint_tiles(Texture& texture, uint32_t begin, uint32_t end, Pattern pattern, const Vec3& color,
                 uint32_t seed) {
  std::vector<float> smooth;
  for (uint32_t x = 0; x <= texture.width / kTile; ++x)
    smooth.push_back(1 +
                     0.4f * fractal({float(x) * 0.05f, float(begin / kTile) * 0.05f, float(seed) * 3.3f}, 2));
  paint_rows(texture, begin, end, [&](uint32_t x, uint32_t y) {
    const float u = float(x) / float(texture.width), v = float(y) / float(texture.height);
    return texel_of(color, shade(pattern, u, v) * smooth[x / kTile] * brightness(grain(x, y, seed)));
  });
}

}  // namespace

Texture paint_texture(Pattern pattern, const Vec3& color, uint32_t width, uint32_t height, uint32_t seed,
                      uint32_t threads) {
  Texture texture{fmt::format("painted_{}", seed), width, height, {}};
  texture.rgba.resize(4 * size_t(width) * height);
  if (pattern == Pattern::Lacquer)
    parallel_ranges(height, 256, threads, [&](size_t begin, size_t end) {
      paint_lacquer(texture, uint32_t(begin), uint32_t(end), color, seed);
    });
  else
    parallel_ranges(height, kTile, threads, [&](size_t begin, size_t end) {
      paint_tiles(texture, uint32_t(begin), uint32_t(end), pattern, color, seed);
    });
  return texture;
}

Texture paint_leaf(const Vec3& color, uint32_t side, uint32_t seed) {
  Texture texture = paint_texture(Pattern::Stone, color, side, side, seed);
  texture.name = fmt::format("leaf_{}", seed);
  for (uint32_t y = 0; y < side; ++y)
    for (uint32_t x = 0; x < side; ++x) {
      const float depth = leaf_depth((float(x) + 0.5f) / float(side), (float(y) + 0.5f) / float(side));
      if (depth <= 0) texture.rgba[4 * (size_t(y) * side + x) + 3] = 0;
    }
  return texture;
}

}  // namespace glint::scenes
