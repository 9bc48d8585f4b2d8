// Implements the ray scheduler `same_region`: nodes near the last one that was asked for come first.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/ray_scheduler.h"

namespace glint::rt {
namespace {

// A region is an aligned piece of memory, for example a row of DRAM. Without a node in the last region, the
// lowest lane of the oldest warp comes first.
class SameRegion final : public RayScheduler {
 public:
  static constexpr std::string_view kName = "same_region";
  static constexpr std::string_view kDoc =
      "Nodes in the region of the last one that was asked for come first.";
  struct Params {
    uint32_t bytes = 2048;
    static ParamList params() {
      return {param(&Params::bytes, "bytes", "byte", "Size of a region.", 64, 1 << 20)};
    }
  };
  SameRegion(Params params, Context context) : bytes_(params.bytes), stats_(context.stats) {}

  Choice choose(std::span<const WarpView> warps, const WantedNodes& wanted) override {
    Choice oldest;
    for (uint32_t warp = 0; warp < warps.size(); ++warp) {
      if (!warps[warp].ready) continue;
      if (oldest.warp == kNone || warps[warp].age < warps[oldest.warp].age) oldest = {warp, -1};
      for (LaneMask rest = wanted.lanes(warp); rest; rest &= rest - 1) {
        const int lane = std::countr_zero(rest);
        if (wanted.node(warp, lane).address / bytes_ != region_) continue;
        ++stats_.followed;
        return {warp, lane};
      }
    }
    if (oldest.warp == kNone) return oldest;
    oldest.lane = std::countr_zero(wanted.lanes(oldest.warp));
    region_ = wanted.node(oldest.warp, oldest.lane).address / bytes_;
    return oldest;
  }

 private:
  struct Stats {
    explicit Stats(stats::Group* parent) : group(parent, "same_region") {}
    stats::Group group;
    stats::Counter followed{&group, "followed", "node", "Number of nodes that lay in the last one's region."};
  };

  const uint32_t bytes_;
  Address region_ = 0;
  Stats stats_;
};

const Register<RayScheduler, SameRegion> registered;

}  // namespace
}  // namespace glint::rt
