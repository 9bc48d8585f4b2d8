// Implements the work mapping `cooperative`: lanes without work take nodes from the stacks of lanes that have
// more (Tozlu, Zhou: "CoopRT", ISCA 2025, doi 10.1145/3695053.3731118).
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "base/registry.h"
#include "rtunit/work_mapping.h"

namespace glint::rt {
namespace {

// Two priority encoders find the first lane that has a node to give and the first that has nothing to do, as
// published. Lanes help within groups of `subwarp`.
class Cooperative final : public WorkMapping {
 public:
  static constexpr std::string_view kName = "cooperative";
  static constexpr std::string_view kDoc =
      "Lanes without work take nodes from the stacks of other lanes of the warp (CoopRT, ISCA 2025).";
  struct Params {
    uint32_t subwarp = 32;  // the published design; it also has 16, 8 and 4
    uint32_t moves = 1;     // the published load-balancing unit moves one node a cycle
    bool take_bottom = false;
    static ParamList params() {
      return {
          param(&Params::subwarp, "subwarp", "lane", "Number of neighbouring lanes that may help each other.",
                2, kLanes),
          param(&Params::moves, "moves", "node",
                "Largest number of nodes that change their lane in a cycle, in all warps of the unit.", 1,
                kLanes),
          flag(&Params::take_bottom, "take_bottom",
               "True: a lane takes the lowest entry of the other's stack. False: it takes the entry under "
               "the top.")};
    }
  };
  Cooperative(const Params& params, Context) : params_(params) {}

  std::optional<WorkMove> choose(const WorkView& view) override {
    for (LaneMask rest = view.givers; rest;) {
      const int giver = std::countr_zero(rest);
      const LaneMask group = group_of(giver);
      if (const LaneMask takers = view.takers & group)
        return WorkMove{giver, std::countr_zero(takers), params_.take_bottom};
      rest &= ~group;
    }
    return std::nullopt;
  }
  uint32_t moves_per_cycle() const override { return params_.moves; }

 private:
  LaneMask group_of(int lane) const {
    const LaneMask lanes = kAllLanes >> (uint32_t(kLanes) - params_.subwarp);
    return lanes << (uint32_t(lane) / params_.subwarp * params_.subwarp);
  }

  const Params params_;
};

const Register<WorkMapping, Cooperative> registered;

}  // namespace
}  // namespace glint::rt
