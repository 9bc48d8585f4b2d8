// Describes a ray in the coordinates of the structure that it walks, with what the intersection tests derive
// from it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace glint::rt {

// The ray stands in the space of the structure that it walks: the world, or the object space of an instance.
struct RaySpace {
  std::array<float, 3> origin{}, direction{}, inverse_direction{};
  std::array<float, 3> shear{};          // Woop et al. 2013: Sx, Sy, Sz
  std::array<uint8_t, 3> axis{0, 1, 2};  // kx, ky, kz: kz is the largest component of the direction
};

}  // namespace glint::rt
