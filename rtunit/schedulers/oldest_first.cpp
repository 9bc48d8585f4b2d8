// Implements the ray scheduler `oldest_first`: the warp that entered the RT unit first sends first, as in the
// published simulators.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/ray_scheduler.h"

namespace glint::rt {
namespace {

class OldestFirst final : public RayScheduler {
 public:
  static constexpr std::string_view kName = "oldest_first";
  static constexpr std::string_view kDoc = "The warp that has been in the unit longest sends first.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  OldestFirst(Params, Context) {}

  uint32_t pick(std::span<const WarpView> warps) override {
    uint32_t best = kNone;
    uint64_t age = ~uint64_t{0};  // of `best`
    // There is no branch, because which warps are ready cannot be foreseen.
    for (uint32_t i = 0; i < warps.size(); ++i) {
      const bool is_older = warps[i].ready & (warps[i].age < age);
      best = is_older ? i : best;
      age = is_older ? warps[i].age : age;
    }
    return best;
  }
};

const Register<RayScheduler, OldestFirst> registered;

}  // namespace
}  // namespace glint::rt
