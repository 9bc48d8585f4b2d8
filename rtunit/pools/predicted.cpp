// Implements the ray pool `predicted`: rays whose look-up has given a node form warps of their own.
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "memsys/ring.h"
#include "rtunit/pools/given_warps.h"
#include "rtunit/ray_pool.h"

namespace glint::rt {
namespace {

// A warp that the core gave begins as it is. Rays whose look-up gives a node (rt.entry) leave it, because
// they are short when the node is right. 32 of them form a warp; when the oldest of them has waited for
// `wait` cycles, a warp is formed of fewer. The other rays stay where they are.
//
// Source: Liu et al., "Intersection prediction for accelerated GPU ray tracing", MICRO 2021.
//
// Choice: these warps take slots of the warp buffer, where the published ones have slots of their own.
class Predicted final : public RayPool {
 public:
  static constexpr std::string_view kName = "predicted";
  static constexpr std::string_view kDoc =
      "Rays whose look-up has given a node (rt.entry) form warps of their own (MICRO 2021).";
  struct Params {
    uint32_t wait = 20;  // published
    static ParamList params() {
      return {
          param(&Params::wait, "wait", "cycle",
                "Cycles from a predicted ray's coming into the pool to a warp that is formed without 32 of "
                "them.",
                0, 100000)};
    }
  };
  Predicted(Params params, Context) : wait_(params.wait) {}

  void add(const WaitingRay& ray, Cycle now) override {
    if (ray.is_predicted)
      predicted_.push({ray.id, now});
    else
      new_.push(ray.id);
  }

  uint32_t form(std::span<uint32_t, kLanes> ids, Cycle now) override {
    if (predicted_.size() < size_t(kLanes) && next_event(now) > now) return new_.take(ids);
    uint32_t count = 0;
    for (; count < uint32_t(kLanes) && !predicted_.empty(); predicted_.pop())
      ids[count++] = predicted_.front().id;
    return count;
  }

  bool takes_predicted(const FormedWarp&, int) override { return true; }
  Cycle next_event(Cycle) const override {
    return predicted_.empty() ? kNever : predicted_.front().since + wait_;
  }

 private:
  struct Waiting {
    uint32_t id = 0;
    Cycle since = 0;
  };

  const Cycle wait_;
  mem::Ring<Waiting> predicted_;  // in order of arrival
  GivenWarps new_;
};

const Register<RayPool, Predicted> registered;

}  // namespace
}  // namespace glint::rt
