// Scans a scheduler's warps, and finds the reason for a cycle without issue.
// SPDX-License-Identifier: Apache-2.0
#include "core/scheduler.h"

#include <bit>

namespace glint::core {

Scheduler::Scheduler(uint32_t index, uint32_t slots, const Params& params)
    : index_(index),
      policy_(params.issue.make({(slots + params.schedulers - 1) / params.schedulers})),
      has_latches_(params.dispatch_latch) {
}

void Scheduler::add(uint32_t warp, uint64_t age) {
  resident_ |= uint64_t{1} << warp;
  age_[warp] = age;
  wake();
}

void Scheduler::remove(uint32_t warp) {
  resident_ &= ~(uint64_t{1} << warp);
  wake();
}

uint64_t Scheduler::find_ready(Cycle now, const Doors& doors) {
  Cycle next = kNever;
  Stall reason = Stall::NoWarp;
  uint64_t free = 0;
  // The loop has no branches, because the warps that wait are others in every cycle.
  for (uint64_t rest = resident_; rest; rest &= rest - 1) {
    const auto i = size_t(std::countr_zero(rest));
    const bool waits = ready_at_[i] > now;
    const Cycle until = waits ? ready_at_[i] : pipe_free_[size_t(pipe_[i])];
    const Stall why = waits ? wait_[i] : Stall::MathThrottle;
    const bool blocked = until > now;
    next = std::min(next, blocked ? until : kNever);
    reason = std::min(reason, blocked ? why : Stall::NoWarp);
    free |= uint64_t{!blocked} << i;
  }
  const uint64_t at_lsu = free & needs_lsu_, at_rt = free & needs_rt_, at_tex = free & needs_tex_;
  const bool lsu_full = at_lsu && !doors.lsu.can_take(index_),
             tex_full = at_tex && !doors.lsu.can_take(index_, true);
  watches_lsu_ = lsu_full || tex_full;
  watches_rt_ = at_rt && !doors.rt.can_accept();
  lsu_vacated_ = doors.lsu.num_vacated();
  if (lsu_full) {
    free &= ~at_lsu;
    reason = std::min(reason, Stall::LsuThrottle);
  }
  if (tex_full) {
    free &= ~at_tex;
    reason = std::min(reason, Stall::TexThrottle);
  }
  if (watches_rt_) {
    free &= ~at_rt;
    reason = std::min(reason, Stall::RtFull);
  }
  reason_ = reason;
  sleep_until_ = next;
  return free;
}

NextIssue Scheduler::next_of(uint32_t warp) const {
  const auto needs = [warp](uint64_t warps) { return (warps >> warp & 1) != 0; };
  const Door door = needs(needs_rt_)    ? Door::RtUnit
                    : needs(needs_tex_) ? Door::Texture
                    : needs(needs_lsu_) ? Door::Lsu
                                        : Door::None;
  return {ready_at_[warp], wait_[warp], pipe_[warp], door};
}

// Returns the reason that the scheduler would have if this warp were its only one.
Stall Scheduler::reason_of(uint32_t warp, Cycle now, const Doors& doors) const {
  const NextIssue next = next_of(warp);
  if (next.ready_at > now) return next.wait;
  if (pipe_free_[size_t(next.pipe)] > now) return Stall::MathThrottle;
  if (next.door == Door::RtUnit && watches_rt_) return Stall::RtFull;
  if (next.door == Door::Texture && !doors.lsu.can_take(index_, true)) return Stall::TexThrottle;
  return next.door == Door::Lsu && !doors.lsu.can_take(index_) ? Stall::LsuThrottle : Stall::RegisterBanks;
}

std::optional<uint32_t> Scheduler::to_blame(Cycle now, const Doors& doors) const {
  std::optional<uint32_t> best;
  bool best_fits = false;
  // Returns whether warp `a` is to blame rather than warp `b`.
  const auto before = [&](uint32_t a, uint32_t b) {
    const Cycle until_a = std::max(ready_at_[a], now), until_b = std::max(ready_at_[b], now);
    return until_a != until_b ? until_a < until_b : age_[a] < age_[b];
  };
  for (uint64_t rest = resident_; rest; rest &= rest - 1) {
    const auto warp = uint32_t(std::countr_zero(rest));
    const bool fits = reason_of(warp, now, doors) == reason_;
    if (best && (fits != best_fits ? best_fits : !before(warp, *best))) continue;
    best = warp;
    best_fits = fits;
  }
  return best;
}

}  // namespace glint::core
