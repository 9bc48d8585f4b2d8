// Implements the ray pool `repack`: rays whose warps have become thin form full warps together.
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

// A warp that the core gave begins as it is. When so many of its rays have stopped that fewer than `least`
// run, the others go back to the pool, provided that there is another warp's worth of rays to take the place.
// 32 rays that came back form a warp; fewer fill the free lanes of a new one.
// Source of `least`: Chou, Aamodt, "Treelet accelerated ray tracing on GPUs", ASPLOS 2025, which repacks
// below 22 lanes.
class Repack final : public RayPool {
 public:
  static constexpr std::string_view kName = "repack";
  static constexpr std::string_view kDoc =
      "The rays of warps in which few are left form full warps together (dynamic warp formation).";
  struct Params {
    uint32_t least = 22;
    static ParamList params() {
      return {param(&Params::least, "least", "ray",
                    "Number of running rays below which a warp's rays go back to the pool.", 1, kLanes)};
    }
  };
  Repack(Params params, Context) : least_(params.least) {}

  void add(const WaitingRay& ray, Cycle) override {
    if (ray.is_new)
      new_.push(ray.id);
    else
      returned_.push(ray.id);
  }

  uint32_t form(std::span<uint32_t, kLanes> ids, Cycle) override {
    uint32_t count = 0;
    if (returned_.size() < size_t(kLanes)) count = new_.take(ids);
    for (; count < uint32_t(kLanes) && !returned_.empty(); returned_.pop()) ids[count++] = returned_.front();
    return count;
  }

  bool goes_back(const FormedWarp& warp, int) override { return is_thin(warp, least_); }

 private:
  const uint32_t least_;
  GivenWarps new_;
  mem::Ring<uint32_t> returned_;  // ids, in order of arrival
};

const Register<RayPool, Repack> registered;

}  // namespace
}  // namespace glint::rt
