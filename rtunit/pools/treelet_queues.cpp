// Implements the ray pool `treelet_queues`: rays that have diverged wait by treelet, and those of one treelet
// form a warp (Chou, Aamodt: "Treelet accelerated ray tracing on GPUs", ASPLOS 2025, doi
// 10.1145/3676641.3716279; known from notes on it, no artifact is public).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/registry.h"
#include "base/stats.h"
#include "rtunit/pools/given_warps.h"
#include "rtunit/ray_pool.h"
#include "rtunit/traversal/traversal.h"
#include "rtunit/treelets.h"

namespace glint::rt {
namespace {

// Holds rays by treelet. A queue exists while it has rays.
class Queues {
 public:
  explicit Queues(uint32_t rays) : next_(rays) {
    ids_.reserve(rays);
    queues_.reserve(rays);
  }

  void push(TreeletId treelet, uint32_t ray) {
    const auto at = size_t(std::find(ids_.begin(), ids_.end(), treelet) - ids_.begin());
    next_[ray] = kEnd;
    if (at == ids_.size()) {
      ids_.push_back(treelet);
      queues_.push_back({ray, ray, 1});
      return;
    }
    next_[queues_[at].last] = ray;
    queues_[at].last = ray;
    ++queues_[at].size;
  }
  bool empty() const { return ids_.empty(); }
  // Returns the treelet with the most rays; there must be one. Of equals it is the one that came first.
  TreeletId longest() const { return ids_[index_of_longest()]; }
  uint32_t longest_size() const { return empty() ? 0 : queues_[index_of_longest()].size; }
  bool has(TreeletId treelet) const { return std::find(ids_.begin(), ids_.end(), treelet) != ids_.end(); }
  // Takes the oldest ray of a treelet that has one.
  uint32_t pop(TreeletId treelet) {
    const auto at = size_t(std::find(ids_.begin(), ids_.end(), treelet) - ids_.begin());
    const uint32_t ray = queues_[at].first;
    queues_[at].first = next_[ray];
    if (--queues_[at].size == 0) {
      ids_.erase(ids_.begin() + ptrdiff_t(at));
      queues_.erase(queues_.begin() + ptrdiff_t(at));
    }
    return ray;
  }

 private:
  static constexpr uint32_t kEnd = ~0u;
  struct Queue {
    uint32_t first = kEnd, last = kEnd, size = 0;
  };
  size_t index_of_longest() const {
    return size_t(std::max_element(queues_.begin(), queues_.end(),
                                   [](const Queue& a, const Queue& b) { return a.size < b.size; }) -
                  queues_.begin());
  }

  std::vector<TreeletId> ids_;
  std::vector<Queue> queues_;   // as ids_
  std::vector<uint32_t> next_;  // by ray: the next one of its queue
};

// A warp begins as the core gave it. When its rays are in more than `spread` treelets, they go back one after
// the other, into the queues of the treelets that they want next. A treelet whose queue has `queue` rays is
// served until its queue is empty: its rays form warps that they leave when they leave the treelet. When no
// queue is so long, the longest queues together form warps whose rays stay, until fewer than `least` run.
// Model: a treelet is not loaded before its first ray asks for a node of it (rt.prefetch = "treelet" does).
// Model: blocks keep their places in the core; the published design gives them up to have more rays.
class TreeletQueues final : public RayPool {
 public:
  static constexpr std::string_view kName = "treelet_queues";
  static constexpr std::string_view kDoc =
      "Rays that have diverged wait by treelet, and those of one treelet form a warp (Chou, Aamodt, ASPLOS "
      "2025).";
  struct Params {
    uint32_t spread = 4;
    uint32_t queue = 32;
    uint32_t least = 22;
    static ParamList params() {
      return {param(&Params::spread, "spread", "treelet",
                    "Largest number of treelets that the rays of a new warp may be in before they go back.",
                    1, kLanes),
              param(&Params::queue, "queue", "ray",
                    "Number of rays that a treelet's queue must have for its rays to form warps of their "
                    "own. 1: every warp of rays that came back is of one treelet (naive treelet queues).",
                    1, 4096),
              param(&Params::least, "least", "ray",
                    "Number of running rays below which the rays of a warp of several treelets go back to "
                    "the pool. 1: they stay (no repacking).",
                    1, kLanes)};
    }
  };
  TreeletQueues(Params params, const Context& context)
      : params_(params),
        treelets_(context.memory),
        stats_(context.stats),
        warps_(context.slots),
        queues_(context.rays) {}

  bool needs_treelets() const override { return true; }

  void add(const WaitingRay& ray, Cycle) override {
    if (ray.is_new)
      new_.push(ray.id);
    else
      queues_.push(treelet_of(*ray.ray), ray.id);
  }

  uint32_t form(std::span<uint32_t, kLanes> ids, Cycle) override {
    forming_ = {};
    if (!new_.empty()) return new_.take(ids);
    if (queues_.empty()) return 0;
    if (!queues_.has(served_))
      served_ = queues_.longest_size() >= params_.queue ? queues_.longest() : kNoTreelet;
    uint32_t count = 0;
    if (served_ != kNoTreelet) {
      forming_ = {Phase::OneTreelet, served_};
      while (count < uint32_t(kLanes) && queues_.has(served_)) ids[count++] = queues_.pop(served_);
      ++stats_.treelet_warps;
      return count;
    }
    forming_ = {Phase::Mixed, kNoTreelet};
    while (count < uint32_t(kLanes) && !queues_.empty()) ids[count++] = queues_.pop(queues_.longest());
    ++stats_.mixed_warps;
    return count;
  }

  void formed(uint32_t slot) override { warps_[slot] = forming_; }

  bool goes_back(const FormedWarp& from, int lane) override {
    Warp& warp = warps_[from.slot];
    if (warp.phase == Phase::Mixed) return is_thin(from, params_.least);
    const TreeletId treelet = treelet_of(from.rays[size_t(lane)]);
    if (warp.phase == Phase::OneTreelet) return treelet != warp.treelet;
    if (!warp.has_spread && warp.at[size_t(lane)] != treelet) {
      warp.at[size_t(lane)] = treelet;
      warp.has_spread = has_spread(warp, from.running);
    }
    return warp.has_spread;
  }

 private:
  enum class Phase : uint8_t { New, OneTreelet, Mixed };
  struct Warp {
    Phase phase = Phase::New;
    TreeletId treelet = kNoTreelet;      // of Phase::OneTreelet
    bool has_spread = false;             // of Phase::New, as is:
    std::array<TreeletId, kLanes> at{};  // the treelet that the lane's ray is in
  };
  struct Stats {
    explicit Stats(stats::Group* parent) : group(parent, "treelet_queues") {}
    stats::Group group;
    stats::Counter treelet_warps{&group, "treelet_warps", "warp",
                                 "Number of warps that were formed from the rays of one treelet."};
    stats::Counter mixed_warps{&group, "mixed_warps", "warp",
                               "Number of warps that were formed from the rays of several short queues."};
  };

  TreeletId treelet_of(const RayState& ray) const { return treelets_.of(next_fetch(ray).address); }
  // Returns whether the running rays of a new warp are in more than `spread` treelets.
  bool has_spread(const Warp& warp, LaneMask running) const {
    std::array<TreeletId, kLanes> seen;
    uint32_t count = 0;
    for (LaneMask rest = running; rest && count <= params_.spread; rest &= rest - 1) {
      const TreeletId at = warp.at[size_t(std::countr_zero(rest))];
      if (std::find(seen.begin(), seen.begin() + count, at) == seen.begin() + count) seen[count++] = at;
    }
    return count > params_.spread;
  }

  const Params params_;
  const Treelets treelets_;
  Stats stats_;
  std::vector<Warp> warps_;  // by slot of the warp buffer
  Warp forming_;             // the warp that form() has named last
  TreeletId served_ = kNoTreelet;
  GivenWarps new_;
  Queues queues_;
};

const Register<RayPool, TreeletQueues> registered;

}  // namespace
}  // namespace glint::rt
