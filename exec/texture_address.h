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

using Gradient = std::array<float, 3>;
// Says how a footprint is sampled: at this level of detail, with so many samples along its longer side.
struct Footprint {
  float lod;
  uint32_t samples;
  bool is_along_y;  // The longer side is dy, and not dx.
};
// Returns the footprint of a pixel (Vulkan, "Scale Factor Operation" and "Level-of-Detail Operation"), whose
// sides are the `count` gradients of the coordinates in x and y. It takes at most `max_anisotropy` samples.
// Choice: a footprint that is short in texels of level 0 takes no more samples than such texels, as Vulkan
// allows.
Footprint footprint_of(const ImageView& image, int count, const Gradient& dx, const Gradient& dy,
                       float max_anisotropy);
// Returns the gradients of (s, t) on the face that `direction` meets (Vulkan, "Cube Map Derivative
// Transformation").
Gradient cube_gradient(const std::array<float, 3>& direction, const Gradient& change);

}  // namespace glint::exec
