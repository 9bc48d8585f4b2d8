// Implements the warp layout `morton`: warps are tiles of 8 by 4 threads in Z-order, and so are lanes.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <string_view>

#include "exec/warp_layout.h"

namespace glint::exec {
namespace {

// Source: Morton, "A Computer Oriented Geodetic Data Base", IBM 1966: the bits of x and y alternate, x
// lowest. Warps that start together lie in a square of the picture.
class MortonOrder final : public WarpLayout {
 public:
  static constexpr std::string_view kName = "morton";
  static constexpr std::string_view kDoc =
      "A warp is a tile of 8x4 threads. Tiles, lanes and blocks are in Z-order.";
  struct Params {
    static ParamList params() { return {}; }
  };
  MortonOrder(Params, Context) {}

  Place tile() const override { return {8, 4}; }
  Place lane_place(int lane) const override {
    const auto bit = [lane](int at) { return uint32_t(lane >> at & 1); };
    return {bit(0) | bit(2) << 1 | bit(4) << 2, bit(1) | bit(3) << 1};
  }

  // Returns the nth place of the Z curve through the smallest square around the grid, without the places
  // outside of the grid. Each quadrant is passed over as a whole while more places lie before the nth one
  // than it has.
  Place nth(uint32_t n, uint32_t columns, uint32_t rows) const override {
    Place at;
    for (uint32_t half = std::bit_ceil(std::max(columns, rows)) / 2; half > 0; half /= 2) {
      for (uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
        const Place corner{at.x + (quadrant & 1 ? half : 0), at.y + (quadrant & 2 ? half : 0)};
        const uint32_t inside = extent(corner.x, half, columns) * extent(corner.y, half, rows);
        if (n < inside) {
          at = corner;
          break;
        }
        n -= inside;
      }
    }
    return at;
  }

 private:
  static uint32_t extent(uint32_t from, uint32_t length, uint32_t end) {
    return from >= end ? 0 : std::min(length, end - from);
  }
};

const Register<WarpLayout, MortonOrder> registered;

}  // namespace
}  // namespace glint::exec
