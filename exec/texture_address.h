// Turns coordinates into texels: wrapping, faces of cubes, levels of detail.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "exec/image_view.h"

namespace glint::exec {

inline constexpr int64_t kBorder = -1;

// Returns the texel of an axis of `size` texels that index `i` stands for, or kBorder.
int64_t wrap(Wrap mode, int64_t i, int64_t size);

// Returns a coordinate in texels as a number whose floor is a moderate integer. Choice: NaN counts as 0
// (Vulkan leaves it undefined).
double tame(Wrap mode, float x, uint32_t size);

// Holds where a direction meets the cube: the face, and coordinates on it from 0 to 1.
struct CubePoint {
  uint32_t face;
  float s, t;
};
CubePoint cube_point(const std::array<float, 3>& direction);

// Holds the texel of a neighbouring face that stands for texel (x, y) outside of `face`, whose sides have
// `size` texels. It does not serve corners, where three faces meet.
struct CubeTexel {
  uint32_t face;
  int64_t x, y;
};
CubeTexel across_edge(uint32_t face, int64_t x, int64_t y, int64_t size);

// Returns log2 of the footprint of a pixel in texels (Vulkan, "Scale Factor Operation", without anisotropy),
// from the `count` gradients of the coordinates in x and y.
using Gradient = std::array<float, 3>;
float level_of_detail(const ImageView& image, int count, const Gradient& dx, const Gradient& dy);
// Returns the gradients of (s, t) on the face that `direction` meets (Vulkan, "Cube Map Derivative
// Transformation").
Gradient cube_gradient(const std::array<float, 3>& direction, const Gradient& change);

}  // namespace glint::exec
