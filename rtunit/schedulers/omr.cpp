// Implements the ray scheduler `omr`: the oldest warp with a lane in the treelet that is read ahead sends
// first (Chou, Nowicki, Aamodt: "Treelet Prefetching For Ray Tracing", MICRO 2023).
// SPDX-License-Identifier: Apache-2.0
#include "base/registry.h"
#include "rtunit/ray_scheduler.h"
#include "rtunit/schedulers/treelet_ahead.h"

namespace glint::rt {
namespace {

class OldestMatchingRay final : public RayScheduler {
 public:
  static constexpr std::string_view kName = "omr";
  static constexpr std::string_view kDoc =
      "The oldest warp with a lane in the treelet that is read ahead sends first (MICRO 2023).";
  struct Params {
    static ParamList params() { return {}; }
  };
  OldestMatchingRay(Params, const Context&) {}

  bool needs_treelet_ahead() const override { return true; }
  Choice choose(std::span<const WarpView> warps, const WantedNodes& wanted) override {
    return {by_treelet_ahead(warps, wanted, 1), -1};
  }
};

const Register<RayScheduler, OldestMatchingRay> registered;

}  // namespace
}  // namespace glint::rt
