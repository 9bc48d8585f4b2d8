// Implements the warp layout `linear`: warps are 32 consecutive launch indices, one after the other.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "exec/warp_layout.h"

namespace glint::exec {
namespace {

class Linear final : public WarpLayout {
 public:
  static constexpr std::string_view kName = "linear";
  static constexpr std::string_view kDoc =
      "A warp has 32 consecutive launch indices (32x1 where rows are that long), row after row.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Linear(Params, Context) {}

  Place tile() const override { return {0, 0}; }
  Place lane_place(int lane) const override { return {uint32_t(lane), 0}; }
  Place nth(uint32_t n, uint32_t columns, uint32_t) const override { return {n % columns, n / columns}; }
};

const Register<WarpLayout, Linear> registered;

}  // namespace
}  // namespace glint::exec
