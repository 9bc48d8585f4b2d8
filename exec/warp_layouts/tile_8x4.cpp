// Implements the warp layout `tile_8x4`: warps are tiles of 8 by 4 threads, row after row of tiles.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "exec/warp_layout.h"

namespace glint::exec {
namespace {

// Neighbours in two directions share more of what their rays meet than 32 threads in a row do.
class Tile8x4 final : public WarpLayout {
 public:
  static constexpr std::string_view kName = "tile_8x4";
  static constexpr std::string_view kDoc = "A warp is a tile of 8x4 threads. Tiles go row after row.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Tile8x4(Params, Context) {}

  Place tile() const override { return {8, 4}; }
  Place lane_place(int lane) const override { return {uint32_t(lane) % 8, uint32_t(lane) / 8}; }
  Place nth(uint32_t n, uint32_t columns, uint32_t) const override { return {n % columns, n / columns}; }
};

const Register<WarpLayout, Tile8x4> registered;

}  // namespace
}  // namespace glint::exec
