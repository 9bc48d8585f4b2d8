// Implements the prefetcher `treelet`: the treelet that most rays are about to enter is read ahead
// (Chou, Nowicki, Aamodt: "Treelet Prefetching For Ray Tracing", MICRO 2023).
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/registry.h"
#include "base/stats.h"
#include "rtunit/prefetcher.h"
#include "rtunit/traversal/traversal.h"
#include "rtunit/treelets.h"

namespace glint::rt {
namespace {

// The values of rt.treelet.heuristic.
constexpr std::string_view kAlways = "always", kPopularity = "popularity", kPartial = "partial",
                           kLatterHalf = "latter_half";
std::vector<std::string> heuristic_names() {
  return {std::string(kAlways), std::string(kPopularity), std::string(kPartial), std::string(kLatterHalf)};
}

// Holds how many lanes are about to visit a node of each treelet.
class Votes {
 public:
  struct Vote {
    TreeletId treelet = kNoTreelet;
    uint32_t lanes = 0;
  };

  void add(TreeletId treelet) {
    ++all_;
    for (Vote& vote : votes_)
      if (vote.treelet == treelet) {
        ++vote.lanes;
        return;
      }
    votes_.push_back({treelet, 1});
  }
  void remove(TreeletId treelet) {
    --all_;
    for (Vote& vote : votes_)
      if (vote.treelet == treelet) {
        if (--vote.lanes == 0) {
          vote = votes_.back();
          votes_.pop_back();
        }
        return;
      }
  }
  // Returns the treelet with most lanes. Of equals, `favourite` comes first, and then the first in memory.
  Vote winner(TreeletId favourite) const {
    Vote best;
    for (const Vote& vote : votes_) {
      if (vote.lanes < best.lanes) continue;
      const bool comes_first =
          vote.treelet == favourite || (best.treelet != favourite && vote.treelet < best.treelet);
      if (vote.lanes > best.lanes || comes_first) best = vote;
    }
    return best;
  }
  uint32_t all() const { return all_; }

 private:
  std::vector<Vote> votes_;
  uint32_t all_ = 0;  // lanes of all treelets
};

// Model: lanes vote whenever one of them has visited a node, and not in each cycle; which treelet a node
// belongs to is known at once, as it is where nodes have been moved together.
class TreeletPrefetcher final : public Prefetcher {
 public:
  static constexpr std::string_view kName = "treelet";
  static constexpr std::string_view kDoc =
      "The treelet that most rays of the unit are about to visit is read ahead (MICRO 2023).";
  struct Params {
    std::string heuristic{kAlways};
    uint32_t popularity = 75;  // the published threshold
    static ParamList params() {
      return {
          choice(&Params::heuristic, "heuristic",
                 "always: all of the treelet is read. popularity: it is read if enough lanes are about to "
                 "visit it. partial: the share of it is read that the lanes are of all lanes. latter_half: "
                 "the half of it that is farther from its root is read.",
                 &heuristic_names),
          param(&Params::popularity, "popularity", "%",
                "Share of the lanes that must be exceeded before a treelet is read, with the heuristic "
                "`popularity`.",
                0, 100)};
    }
  };
  TreeletPrefetcher(const Params& params, const Context& context)
      : params_(params),
        queue_(context.queue),
        treelets_(context.memory),
        next_(context.warps),
        group_(context.stats, "treelet") {}

  bool needs_treelets() const override { return true; }
  TreeletId treelet_ahead() const override { return ahead_; }

  void entered(uint32_t slot, int lane, const RayState& ray, Cycle) override { look(slot, lane, ray); }
  void visited(const Visit& visit) override { look(visit.slot, visit.lane, visit.ray); }
  void left(uint32_t slot, Cycle) override {
    for (TreeletId& next : next_[slot]) set(next, kNoTreelet);
  }

 private:
  void look(uint32_t slot, int lane, const RayState& ray) {
    const bool goes_on = ray.status == RayStatus::Traversing;
    TreeletId& next = next_[slot][size_t(lane)];
    const TreeletId now = goes_on ? treelets_.of(next_fetch(ray).address) : kNoTreelet;
    if (now == next) return;
    set(next, now);
    const Votes::Vote winner = votes_.winner(ahead_);
    if (winner.treelet != kNoTreelet && winner.treelet != ahead_) read_ahead(winner);
  }

  void set(TreeletId& next, TreeletId now) {
    if (next != kNoTreelet) votes_.remove(next);
    next = now;
    if (next != kNoTreelet) votes_.add(next);
  }

  void read_ahead(const Votes::Vote& vote) {
    if (params_.heuristic == kPopularity && vote.lanes * 100 <= votes_.all() * params_.popularity) {
      ++unpopular_;
      return;
    }
    ahead_ = vote.treelet;
    ++chosen_;
    sectors_.clear();
    treelets_.for_each_node(ahead_, [&](const Fetch& node) {
      Address at = node.address & ~Address{mem::kSectorBytes - 1};
      for (; at < node.address + node.bytes; at += mem::kSectorBytes)
        if (sectors_.empty() || sectors_.back() != at) sectors_.push_back(at);
    });
    size_t first = 0, end = sectors_.size();
    if (params_.heuristic == kPartial) end = (end * vote.lanes + votes_.all() - 1) / votes_.all();
    if (params_.heuristic == kLatterHalf) first = end / 2;
    for (size_t i = first; i < end; ++i) queue_.want(sectors_[i]);
  }

  const Params params_;
  PrefetchQueue& queue_;
  const Treelets treelets_;
  std::vector<std::array<TreeletId, kLanes>> next_;  // of each lane's next node, by slot
  Votes votes_;
  TreeletId ahead_ = kNoTreelet;  // the treelet that was read ahead last
  std::vector<Address> sectors_;
  stats::Group group_;
  stats::Counter chosen_{&group_, "chosen", "treelet",
                         "Number of times that another treelet was read ahead."};
  stats::Counter unpopular_{&group_, "unpopular", "vote",
                            "Number of votes whose treelet too few lanes were about to visit."};
};

const Register<Prefetcher, TreeletPrefetcher> registered;

}  // namespace
}  // namespace glint::rt
