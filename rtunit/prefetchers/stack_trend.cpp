// Implements the prefetcher `stack_trend`: while a ray climbs, the nodes on its stack are read ahead
// (Tozlu, Naithani, Zhou: "Traversal-trend prefetcher", ISCA 2026, arXiv 2605.16253).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/registry.h"
#include "rtunit/prefetcher.h"
#include "rtunit/traversal/traversal.h"

namespace glint::rt {
namespace {

// Holds the nodes asked for last, so that a node is not asked for twice in a row.
struct Recent {
  static constexpr size_t kMost = 16;  // nodes a lane and nodes a warp, as in the published artifact
  std::array<Address, kMost> address{};
  size_t next = 0;
  bool has(Address at) const { return std::find(address.begin(), address.end(), at) != address.end(); }
  void add(Address at) { address[next++ % kMost] = at; }
};

// A depth-first walk has a trend: after a visit that pushed nothing, another such visit is likely, and the
// nodes that it will take are on the stack. The first such visit in a row asks for one entry from the top,
// the second for two, and later ones for `depth`. A visit that pushes ends the trend.
// Model: entries behind the ray's hit are not asked for where the stack keeps distances (rt.retest).
class StackTrend final : public Prefetcher {
 public:
  static constexpr std::string_view kName = "stack_trend";
  static constexpr std::string_view kDoc =
      "While the visits of a ray push nothing, the nodes on its stack are read ahead (TTP, ISCA 2026).";
  struct Params {
    uint32_t depth = 16;  // the published width of the third and later steps
    static ParamList params() {
      return {param(&Params::depth, "depth", "entry",
                    "Largest number of entries from the top of a stack that are read ahead, from the third "
                    "visit in a row without a push on.",
                    1, kStackEntries)};
    }
  };
  StackTrend(Params params, Context context)
      : queue_(context.queue),
        window_{0, 1, std::min(2u, params.depth), params.depth},
        warps_(context.warps) {}

  void entered(uint32_t slot, int lane, const RayState& ray, Cycle) override {
    warps_[slot].lane[size_t(lane)] = {0, ray.stack_size, {}};
  }

  void visited(const Visit& visit) override {
    Lane& lane = warps_[visit.slot].lane[size_t(visit.lane)];
    const RayState& ray = visit.ray;
    lane.asked_from = std::min(lane.asked_from, ray.stack_size);
    if (visit.pushed) {
      lane.trend = 0;
      lane.asked_from = ray.stack_size;
      return;
    }
    lane.trend = std::min(lane.trend + 1, 3u);
    const int lowest = std::max(int(ray.stack_size) - int(window_[lane.trend]), 0);
    for (; lane.asked_from > lowest; --lane.asked_from)
      ask(ray, size_t(lane.asked_from) - 1, lane.recent, warps_[visit.slot].recent);
  }

 private:
  struct Lane {
    uint32_t trend = 0;      // visits in a row that pushed nothing, at most 3
    int16_t asked_from = 0;  // Entries of the stack from this one on have been asked for.
    Recent recent;
  };
  struct Warp {
    std::array<Lane, kLanes> lane;
    Recent recent;
  };

  void ask(const RayState& ray, size_t entry, Recent& of_lane, Recent& of_warp) {
    if (ray.rules.retest && ray.stack[entry].t_enter > ray.committed.t) return;
    const Fetch node = fetch_of_entry(ray, entry);
    if (of_lane.has(node.address) || of_warp.has(node.address)) return;
    of_lane.add(node.address);
    of_warp.add(node.address);
    queue_.want(node);
  }

  PrefetchQueue& queue_;
  const std::array<uint32_t, 4> window_;  // entries from the top, by trend
  std::vector<Warp> warps_;               // by slot
};

const Register<Prefetcher, StackTrend> registered;

}  // namespace
}  // namespace glint::rt
