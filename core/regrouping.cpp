// Sorts running threads by key, deals them out to warps, and finds the swaps that take them there.
// SPDX-License-Identifier: Apache-2.0
#include "core/regrouping.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "base/num_lanes.h"

namespace glint::core {

Regrouping::Regrouping(uint32_t max_warps) : places_(max_warps) {
  threads_.reserve(size_t{max_warps} * kLanes);
  swaps_.reserve(size_t{max_warps} * kLanes);
}

std::span<const Regrouping::Swap> Regrouping::plan(std::span<const Warp> warps, bool compact) {
  swaps_.clear();
  sort_threads(warps);
  for (size_t w = 0; w < warps.size(); ++w)
    for (int lane = 0; lane < kLanes; ++lane)
      places_[w][size_t(lane)] = {warps[w].live >> lane & 1 ? kWaits : kEnded, uint8_t(w)};
  choose_targets(warps, compact);
  for (size_t w = 0; w < warps.size(); ++w) bring_home(uint8_t(w), warps);
  num_moved_ = 0;
  for (size_t w = 0; w < warps.size(); ++w)
    for (const Place& place : places_[w]) num_moved_ += place.target != kEnded && place.origin != w;
  return swaps_;
}

void Regrouping::sort_threads(std::span<const Warp> warps) {
  threads_.clear();
  for (size_t w = 0; w < warps.size(); ++w)
    for_each_lane(warps[w].running, [&](int lane) {
      threads_.push_back({warps[w].keys[size_t(lane)], uint8_t(w), uint8_t(lane)});
    });
  std::sort(threads_.begin(), threads_.end(), [](const Thread& a, const Thread& b) {
    return std::tie(a.key, a.warp, a.lane) < std::tie(b.key, b.warp, b.lane);
  });
}

// Deals out the sorted threads. Of the warps that are left, the one that has most of the next threads already
// takes them.
void Regrouping::choose_targets(std::span<const Warp> warps, bool compact) {
  const auto capacity = [&](size_t w) {
    return size_t(num_lanes(compact ? warps[w].movable : warps[w].running));
  };
  uint64_t left = warps.size() == 64 ? ~uint64_t{0} : (uint64_t{1} << warps.size()) - 1;
  for (size_t next = 0; next < threads_.size();) {
    size_t best = 0, end = next;
    int64_t best_own = -1;
    for (size_t w = 0; w < warps.size(); ++w) {
      if (!(left >> w & 1) || capacity(w) == 0) continue;
      const auto first = threads_.begin() + std::ptrdiff_t(next);
      const size_t count = std::min(capacity(w), threads_.size() - next);
      const auto own = int64_t(std::count_if(first, first + std::ptrdiff_t(count),
                                             [&](const Thread& thread) { return thread.warp == w; }));
      if (own > best_own) best = w, best_own = own, end = next + count;
    }
    left &= ~(uint64_t{1} << best);
    for (; next < end; ++next) places_[threads_[next].warp][threads_[next].lane].target = uint8_t(best);
  }
}

// Swaps the warp's threads that are elsewhere for others that are there.
void Regrouping::bring_home(uint8_t warp, std::span<const Warp> warps) {
  for (size_t from = 0; from < warps.size(); ++from) {
    if (from == warp) continue;
    for (size_t lane = 0; lane < size_t(kLanes); ++lane) {
      if (places_[from][lane].target != warp) continue;
      const auto to = size_t(find_place(warp, warps[warp].movable, uint8_t(from)));
      std::swap(places_[warp][to], places_[from][lane]);
      swaps_.push_back({warp, uint8_t(to), uint8_t(from), uint8_t(lane)});
    }
  }
}

// Returns the lane of the warp whose thread is best swapped for one from `from`: a thread that belongs there,
// then another running one, then one that has ended, and then one that waits.
int Regrouping::find_place(uint8_t warp, LaneMask movable, uint8_t from) const {
  int best = -1, best_rank = 4;
  for_each_lane(movable, [&](int lane) {
    const uint8_t target = places_[warp][size_t(lane)].target;
    if (target == warp) return;
    const int rank = target == from ? 0 : target < kWaits ? 1 : target == kEnded ? 2 : 3;
    if (rank < best_rank) best = lane, best_rank = rank;
  });
  return best;
}

}  // namespace glint::core
