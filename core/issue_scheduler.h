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

// Contract (tests/contract/issue_scheduler_test.cpp):
//  - pick() returns the number of a set bit of `ready`.
//  - The pick is a function of the views so far and of the policy's own state: the same views give the same
//    picks.
//  - No ready warp starves: when a picked warp is not ready for as many picks as there are warps, every warp
//    that stays ready is picked. (A greedy policy may stay with one warp for as long as that warp is ready.)
//  - pick() is called only in cycles with a ready warp, so a policy must not count calls as cycles.
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
};

}  // namespace glint::core
