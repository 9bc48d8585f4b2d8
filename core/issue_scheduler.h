// Declares the interface of the policies that choose which ready warp a scheduler of a core issues from in a
// cycle.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <memory>
#include <span>

#include "base/registry.h"
#include "base/types.h"
#include "core/l1_listener.h"

namespace glint::core {

inline constexpr uint32_t kMaxWarpsPerScheduler = 64;  // number of bits of IssueView::ready

// Holds what a scheduler sees of its warps' rays. All is 0 unless the policy's needs_rt() holds.
struct RtView {
  uint64_t at_rays = 0;   // bit i: the next instruction of warp i gives rays to the RT unit
  bool has_room = false;  // The RT unit takes another warp.
};

// Holds what a scheduler sees of its warps in one cycle. Warps are numbered locally, from 0.
struct IssueView {
  uint64_t ready = 0;             // bit i: warp i can issue this cycle; at least one bit is set
  std::span<const uint64_t> age;  // launch number of each warp: smaller is older; unique among resident warps
  Cycle now = 0;
  RtView rt = {};
  // These are 0 unless the policy's holds_back() holds, and set in allowed() only. Bit i: warp i holds its
  // slot; the next instruction of warp i goes to the load-store unit.
  uint64_t resident = 0, at_memory = 0;
};

// Returns the oldest of some warps; there must be one.
inline uint32_t oldest_of(uint64_t warps, const IssueView& view) {
  uint32_t oldest = uint32_t(std::countr_zero(warps));
  for (uint64_t rest = warps & (warps - 1); rest; rest &= rest - 1) {
    const uint32_t i = uint32_t(std::countr_zero(rest));
    if (view.age[i] < view.age[oldest]) oldest = i;
  }
  return oldest;
}

// Remembers the warp that was issued last, for policies that go on with it.
class LastIssued {
 public:
  // Returns whether the warp is ready. A new warp in the same slot is not the warp that was issued last.
  bool is_ready(const IssueView& view) const { return (view.ready >> warp_ & 1) && view.age[warp_] == age_; }
  uint32_t warp() const { return warp_; }
  // Notes that `warp` is issued, and returns it.
  uint32_t note(uint32_t warp, const IssueView& view) {
    age_ = view.age[warp];
    return warp_ = warp;
  }

 private:
  uint32_t warp_ = 0;
  uint64_t age_ = ~uint64_t{0};
};

// Contract (tests/contract/issue_scheduler_test.cpp):
//  - pick() returns the number of a set bit of `ready`.
//  - The pick is a function of the views so far and of the policy's own state: the same views give the same
//    picks.
//  - No ready warp starves: when a picked warp is not ready for as many picks as there are warps, every warp
//    that stays ready is picked. (A greedy policy may stay with one warp for as long as that warp is ready.)
//  - pick() is called only in cycles with a ready warp, so a policy must not count calls as cycles.
//  - A policy that holds warps back lets each of them go on after some cycles in which no other warp issues.
//    Cycles in which all ready warps are held back count as lsu_throttle.
class IssueScheduler {
 public:
  static constexpr PolicyKind kKind{"core.issue", "core/schedulers"};
  struct Context {
    uint32_t num_warps = 1;  // local warps: 1 to kMaxWarpsPerScheduler
  };
  virtual ~IssueScheduler() = default;
  // Returns whether pick() looks at IssueView::rt. It is asked once.
  virtual bool needs_rt() const { return false; }
  virtual uint32_t pick(const IssueView& view) = 0;
  // Returns who hears what the L1 does for the scheduler's warps, or null when the policy does not care. It
  // is asked before the first cycle.
  virtual L1Listener* l1_listener() { return nullptr; }
  // Returns whether ready warps may be kept from issuing. It is asked once.
  virtual bool holds_back() const { return false; }
  // Returns the warps of `view.ready` that may issue in this cycle; pick() gets these. It is called in every
  // cycle with a ready warp, and only when holds_back() holds.
  virtual uint64_t allowed(const IssueView& view) { return view.ready; }
};

}  // namespace glint::core
