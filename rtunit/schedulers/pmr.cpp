// Implements the ray scheduler `pmr`: the warp with the most lanes in the treelet that is read ahead sends
// first (Chou, Nowicki, Aamodt: "Treelet Prefetching For Ray Tracing", MICRO 2023).
// SPDX-License-Identifier: Apache-2.0
#include "base/registry.h"
#include "rtunit/ray_scheduler.h"
#include "rtunit/schedulers/treelet_ahead.h"

namespace glint::rt {
namespace {

class MostMatchingRays final : public RayScheduler {
 public:
  static constexpr std::string_view kName = "pmr";
  static constexpr std::string_view kDoc =
      "The warp with the most lanes in the treelet that is read ahead sends first (MICRO 2023).";
  struct Params {
    static ParamList params() { return {}; }
  };
  MostMatchingRays(Params, const Context&) {}

  bool needs_treelet_ahead() const override { return true; }
  Choice choose(std::span<const WarpView> warps, const WantedNodes& wanted) override {
    return {by_treelet_ahead(warps, wanted, kLanes), -1};
  }
};

const Register<RayScheduler, MostMatchingRays> registered;

}  // namespace
}  // namespace glint::rt
