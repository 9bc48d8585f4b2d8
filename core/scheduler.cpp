// Scans a scheduler's warps, and finds the reason for a cycle without issue.
// SPDX-License-Identifier: Apache-2.0
#include "core/scheduler.h"

#include <bit>

namespace glint::core {

Scheduler::Scheduler(uint32_t index, uint32_t slots, const Params& params, Alarms& alarms)
    : index_(index),
      has_latches_(params.dispatch_latch),
      alarms_(alarms),
      policy_(params.issue.make({(slots + params.schedulers - 1) / params.schedulers})),
      needs_rt_(policy_->needs_rt()),
      policy_holds_(policy_->holds_back()) {
  may_hold_back_ = policy_holds_ || params.register_file.banks > 0 || params.interleaving.make({})->is_used();
}

uint64_t Scheduler::leave_out_held(uint64_t ready, Cycle now) {
  if (!policy_holds_) return ready;
  IssueView view{ready, {age_.data(), age_.size()}, now, {}};
  view.resident = resident_;
  view.at_memory = resident_ & needs_door_[size_t(Door::Lsu)];
  const uint64_t allowed = policy_->allowed(view);
  GLINT_DCHECK(!(allowed & ~ready), "the issue policy allows warps that are not ready: {:#x}",
               allowed & ~ready);
  if (allowed != ready) {
    reason_ = std::min(reason_, Stall::LsuThrottle);
    alarms_.sleep_less(index_, now + 1);
  }
  return allowed;
}

void Scheduler::add(uint32_t warp, uint64_t age) {
  resident_ |= uint64_t{1} << warp;
  age_[warp] = age;
  wake();
}

void Scheduler::remove(uint32_t warp) {
  operands_.set(warp, kNever);
  resident_ &= ~(uint64_t{1} << warp);
  wake();
}

uint64_t Scheduler::leave_out_full_doors(uint64_t ready, const Doors& doors) {
  const auto at = [&](Door door) { return ready & needs_door_[size_t(door)]; };
  uint64_t full = 0;
  if (at(Door::Lsu) && !doors.lsu.can_take(index_)) full |= at(Door::Lsu);
  if (at(Door::Texture) && !doors.lsu.can_take(index_, true)) full |= at(Door::Texture);
  const bool watches_lsu = full != 0;
  lsu_vacated_ = doors.lsu.num_vacated();
  watches_rt_ = at(Door::RtUnit) && !doors.rt.can_accept();
  if (watches_rt_) full |= at(Door::RtUnit);
  watches_lsu_ = watches_lsu;
  if (watches_lsu_ || watches_rt_) alarms_.watch(index_);
  return ready & ~full;
}

// Finds the reason of a cycle without issue, and when it ends. `waiting` are the warps without their
// operands; `at_pipes` and `at_doors` are those in front of busy pipes and full doors. A warp in front of a
// pipe is nearest to issue, and one that waits for operands is farthest.
void Scheduler::find_reason(uint64_t waiting, uint64_t at_pipes, uint64_t at_doors) {
  Cycle next = operands_.next();
  if (at_pipes) {
    reason_ = Stall::MathThrottle;
    // There is no branch, because which pipes are busy cannot be foreseen.
    for (size_t pipe = 0; pipe < size_t(kNumTimedPipes); ++pipe) {
      const auto nobody = Cycle{(at_pipes & needs_pipe_[pipe]) == 0};
      next = std::min(next, pipe_free_[pipe] | (Cycle{0} - nobody));
    }
  } else if (at_doors) {
    reason_ = at_doors & needs_door_[size_t(Door::Lsu)]       ? Stall::LsuThrottle
              : at_doors & needs_door_[size_t(Door::Texture)] ? Stall::TexThrottle
                                                              : Stall::RtFull;
  } else if (waiting) {
    auto nearest = size_t(Stall::RawFixed);
    while (!(waits_[nearest] & waiting)) ++nearest;
    reason_ = Stall(nearest);
  } else {
    reason_ = Stall::NoWarp;
  }
  alarms_.sleep(index_, next);
}

NextIssue Scheduler::next_of(uint32_t warp) const {
  const Needs& needs = needs_[warp];
  return {operands_.at(warp), needs.wait, needs.pipe, needs.door, needs.row};
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
    const Cycle until_a = std::max(operands_.at(a), now), until_b = std::max(operands_.at(b), now);
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
