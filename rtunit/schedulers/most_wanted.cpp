// Implements the ray scheduler `most_wanted`: the node that most lanes of all warps want is asked for first.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/registry.h"
#include "rtunit/ray_scheduler.h"

namespace glint::rt {
namespace {

// Nodes are counted in a small table by a hash of their address. Model: two nodes that meet in an entry count
// as one, as in a table without tags. Of nodes that are wanted equally, that of the oldest warp and the
// lowest lane is asked for. A warp that has waited for `patience` choices goes first, so that none waits for
// ever.
class MostWanted final : public RayScheduler {
 public:
  static constexpr std::string_view kName = "most_wanted";
  static constexpr std::string_view kDoc = "The node that most lanes of all warps want is asked for first.";
  struct Params {
    uint32_t patience = 256;
    static ParamList params() {
      return {param(&Params::patience, "patience", "request",
                    "Number of requests of other warps after which a ready warp goes first.", 1, 1'000'000)};
    }
  };
  MostWanted(const Params& params, const Context& context)
      : patience_(params.patience), passed_over_(context.warps) {}

  Choice choose(std::span<const WarpView> warps, const WantedNodes& wanted) override {
    count_.fill(0);
    for (uint32_t warp = 0; warp < warps.size(); ++warp)
      if (warps[warp].ready)
        for_each_lane(wanted.lanes(warp), [&](int lane) { ++count_[entry_of(wanted.node(warp, lane))]; });
    Choice best;
    uint32_t most = 0;
    for (uint32_t warp = 0; warp < warps.size(); ++warp) {
      if (!warps[warp].ready) continue;
      if (passed_over_[warp] >= patience_) return take(warps, {warp, -1});
      for_each_lane(wanted.lanes(warp), [&](int lane) {
        const uint32_t lanes = count_[entry_of(wanted.node(warp, lane))];
        const bool is_older = best.warp != kNone && warps[warp].age < warps[best.warp].age;
        if (lanes < most || (lanes == most && !is_older)) return;
        most = lanes;
        best = {warp, lane};
      });
    }
    return take(warps, best);
  }

 private:
  static size_t entry_of(const Fetch& node) {
    return size_t(node.address / kBlockBytes * 0x9e37'79b1u >> 8 & 1023);
  }

  // Notes who has been passed over.
  Choice take(std::span<const WarpView> warps, Choice choice) {
    for (uint32_t warp = 0; warp < warps.size(); ++warp)
      passed_over_[warp] = warp == choice.warp || !warps[warp].ready ? 0 : passed_over_[warp] + 1;
    return choice;
  }

  const uint32_t patience_;
  std::vector<uint32_t> passed_over_;   // requests of others since the warp became ready, by slot
  std::array<uint16_t, 1024> count_{};  // lanes that want the nodes of an entry
};

const Register<RayScheduler, MostWanted> registered;

}  // namespace
}  // namespace glint::rt
