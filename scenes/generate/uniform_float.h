// Draws uniform floats from a Mersenne Twister, bit for bit as libstdc++ draws them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <random>

namespace glint::scenes {

// Returns the next value of std::uniform_real_distribution<float>(0, 1) in libstdc++. The standard leaves the
// formula open and LumiBench's scenes were drawn with libstdc++, so the formula stands here: one 32-bit draw,
// rounded to float, over 2^32. A draw that rounds up to 1 becomes the largest float below 1.
inline float uniform_float(std::mt19937& engine) {
  const float value = static_cast<float>(engine()) / 4294967296.0f;
  return value < 1 ? value : 0x1.fffffep-1f;
}

}  // namespace glint::scenes
