// Implements the ray scheduler `round_robin`: the warps in the unit take turns at the request port.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/ray_scheduler.h"

namespace glint::rt {
namespace {

class RoundRobin final : public RayScheduler {
 public:
  static constexpr std::string_view kName = "round_robin";
  static constexpr std::string_view kDoc = "The next ready warp after the one that sent last sends.";
  struct Params {
    static ParamList params() { return {}; }
  };
  RoundRobin(Params, Context) {}

  uint32_t pick(std::span<const WarpView> warps) override {
    for (size_t step = 1; step <= warps.size(); ++step) {
      const size_t at = (last_ + step) % warps.size();
      if (!warps[at].ready) continue;
      last_ = at;
      return uint32_t(at);
    }
    return kNone;
  }

 private:
  size_t last_ = 0;
};

const Register<RayScheduler, RoundRobin> registered;

}  // namespace
}  // namespace glint::rt
