// Writes boxes in a few bits per plane. The number of a plane counts steps from the origin of its axis, and a
// step is a power of two (Ylitie et al. 2017, section 3.1).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/check.h"
#include "rtunit/structure/structure.h"

namespace glint::rt {

// Turns bytes into planes: plane q lies at origin[axis] + q * 2^(exponent[axis] - 127), and the sum is
// rounded to float once.
struct Grid {
  std::array<float, 3> origin{};
  std::array<uint8_t, 3> exponent{};  // biased as in a float, 1..254

  static float step(uint8_t exponent) { return std::bit_cast<float>(uint32_t(exponent) << 23); }
  float step(size_t axis) const { return step(exponent[axis]); }
  static float plane(float origin, int q, float step) { return origin + float(q) * step; }
};

// The largest number of a plane in 8 bits.
inline constexpr int kMostInByte = 255;

// Holds the planes of a node's children on one axis.
template <class Number>
struct QuantisedPlanes {
  std::span<Number> low, high;
};

// Quantises with the grid's present origin and exponent. Returns false when a plane's number is above kMost.
template <int kMost, class Number>
bool quantise_with_step(std::span<const Bounds> boxes, size_t axis, const Grid& grid,
                        QuantisedPlanes<Number> planes) {
  const float origin = grid.origin[axis], step = grid.step(axis);
  for (size_t i = 0; i < boxes.size(); ++i) {
    const Bounds& box = boxes[i];
    const double low = std::floor((double(box.low[axis]) - origin) / step);
    const double high = std::ceil((double(box.high[axis]) - origin) / step);
    if (high > kMost) return false;
    int q_low = int(low), q_high = int(high);
    // The decoded plane is rounded to float. It moves outwards until it does not lie inside the box.
    while (q_low > 0 && Grid::plane(origin, q_low, step) > box.low[axis]) --q_low;
    while (q_high <= kMost && Grid::plane(origin, q_high, step) < box.high[axis]) ++q_high;
    if (q_high > kMost) return false;
    planes.low[i] = Number(q_low);
    planes.high[i] = Number(q_high);
  }
  return true;
}

// Gives one axis of `grid` the finest steps that hold all boxes, and sets the planes of the boxes, rounded
// outwards. Their numbers are at most kMost.
template <int kMost, class Number>
void quantise(std::span<const Bounds> boxes, size_t axis, Grid& grid, QuantisedPlanes<Number> planes) {
  float low = 0, high = 0;
  for (size_t i = 0; i < boxes.size(); ++i) {
    low = i ? std::fmin(low, boxes[i].low[axis]) : boxes[i].low[axis];
    high = i ? std::fmax(high, boxes[i].high[axis]) : boxes[i].high[axis];
  }
  grid.origin[axis] = low;
  // Begins with the smallest power of two that has kMost steps over the extent.
  const double step = (double(high) - low) / kMost;
  int exponent = step > 0 ? std::ilogb(step) + 127 : 1;
  for (exponent = exponent < 1 ? 1 : exponent;; ++exponent) {
    GLINT_CHECK(exponent <= 254, "a box of {} to {} does not fit in {} steps", low, high, kMost);
    grid.exponent[axis] = uint8_t(exponent);
    if (quantise_with_step<kMost>(boxes, axis, grid, planes)) return;
  }
}

}  // namespace glint::rt
