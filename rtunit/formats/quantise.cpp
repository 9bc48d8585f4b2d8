// Outward quantisation of boxes.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/formats/quantise.h"

#include <cmath>

#include "base/check.h"

namespace glint::rt {
namespace {

// False when a plane does not fit in 8 bits.
bool fits(std::span<const Bounds> boxes, size_t axis, const Grid& grid, QuantisedPlanes planes) {
  const float origin = grid.origin[axis], step = grid.step(axis);
  for (size_t i = 0; i < boxes.size(); ++i) {
    const Bounds& box = boxes[i];
    const double low = std::floor((double(box.low[axis]) - origin) / step);
    const double high = std::ceil((double(box.high[axis]) - origin) / step);
    if (high > 255) return false;
    int q_low = int(low), q_high = int(high);
    // the decoded plane is rounded to float: step outwards until it is not inside the box
    while (q_low > 0 && Grid::plane(origin, uint8_t(q_low), step) > box.low[axis]) --q_low;
    while (q_high <= 255 && Grid::plane(origin, uint8_t(q_high), step) < box.high[axis]) ++q_high;
    if (q_high > 255) return false;
    planes.low[i] = uint8_t(q_low);
    planes.high[i] = uint8_t(q_high);
  }
  return true;
}

}  // namespace

void quantise(std::span<const Bounds> boxes, size_t axis, Grid& grid, QuantisedPlanes planes) {
  float low = 0, high = 0;
  for (size_t i = 0; i < boxes.size(); ++i) {
    low = i ? std::fmin(low, boxes[i].low[axis]) : boxes[i].low[axis];
    high = i ? std::fmax(high, boxes[i].high[axis]) : boxes[i].high[axis];
  }
  grid.origin[axis] = low;
  // smallest power of two with 255 steps over the extent
  const double step = (double(high) - low) / 255;
  int exponent = step > 0 ? std::ilogb(step) + 127 : 1;
  for (exponent = exponent < 1 ? 1 : exponent;; ++exponent) {
    GLINT_CHECK(exponent <= 254, "a box of {} to {} does not fit in 8 bits a plane", low, high);
    grid.exponent[axis] = uint8_t(exponent);
    if (fits(boxes, axis, grid, planes)) return;
  }
}

}  // namespace glint::rt
