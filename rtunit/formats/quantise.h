// Boxes in 8 bits a plane: steps of a power of two from an origin, an axis at a time (Ylitie et al. 2017, section 3.1).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rtunit/structure.h"

namespace glint::rt {

// What turns bytes into planes: plane q lies at origin[axis] + q * 2^(exponent[axis] - 127), rounded to float once.
struct Grid {
  std::array<float, 3> origin{};
  std::array<uint8_t, 3> exponent{};  // biased as in a float, 1..254

  float step(size_t axis) const { return std::bit_cast<float>(uint32_t(exponent[axis]) << 23); }
  static float plane(float origin, uint8_t q, float step) { return origin + float(q) * step; }
};

// Planes of a node's children on one axis.
struct QuantisedPlanes {
  std::span<uint8_t> low, high;
};

// Sets one axis of `grid` to the finest that holds all boxes, and their planes, rounded outwards.
void quantise(std::span<const Bounds> boxes, size_t axis, Grid& grid, QuantisedPlanes planes);

}  // namespace glint::rt
