// Implements the ray pool `repack`: rays whose warps have become thin form full warps together.
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/num_lanes.h"
#include "base/registry.h"
#include "memsys/ring.h"
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

  void add(const WaitingRay& ray, Cycle) override { (ray.is_new ? new_ : returned_).push(ray.id); }

  uint32_t form(std::span<uint32_t, kLanes> ids, Cycle) override {
    uint32_t count = 0;
    if (returned_.size() < size_t(kLanes) && !new_.empty())
      for (const uint32_t warp = new_.front() / kLanes; !new_.empty() && new_.front() / kLanes == warp;)
        take(new_, ids, count);
    while (count < uint32_t(kLanes) && !returned_.empty()) take(returned_, ids, count);
    return count;
  }

  bool goes_back(const FormedWarp& warp, int) override {
    const uint32_t running = num_lanes(warp.running);
    return running < least_ && running + warp.waiting >= uint32_t(kLanes);
  }

 private:
  static void take(mem::Ring<uint32_t>& from, std::span<uint32_t, kLanes> ids, uint32_t& count) {
    ids[count++] = from.front();
    from.pop();
  }

  const uint32_t least_;
  mem::Ring<uint32_t> new_, returned_;  // ids, in order of arrival
};

const Register<RayPool, Repack> registered;

}  // namespace
}  // namespace glint::rt
