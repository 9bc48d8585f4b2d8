// Which instruction a scheduler's idle cycle is charged to.
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "core/core_cell.h"

namespace glint::core {

void CoreCell::start_profile() {
  profile_ = std::make_unique<Profile>(world_.image->code.size(), params_.schedulers);
}

// What warp `i` by itself would give as the reason.
Stall CoreCell::reason_of(const SchedulerState& scheduler, size_t i, Cycle now) const {
  if (scheduler.ready_at[i] > now) return scheduler.wait[i];
  if (scheduler.pipe_free[size_t(scheduler.pipe[i])] > now) return Stall::MathThrottle;
  if (scheduler.needs_rt >> i & 1 && scheduler.watches_rt) return Stall::RtFull;
  if (scheduler.needs_tex >> i & 1 && !lsu_.can_take(scheduler.index, true)) return Stall::TexThrottle;
  return scheduler.needs_lsu >> i & 1 && !lsu_.can_take(scheduler.index) ? Stall::LsuThrottle
                                                                         : Stall::RegisterBanks;
}

// The warp that gave the scheduler its reason: of several the one that can go on first, then the oldest. As
// in hardware's sampling it is charged where it waits, the instruction that it would issue next; but for
// rays, which are charged where they were traced.
uint32_t CoreCell::blamed_pc(const SchedulerState& scheduler, Cycle now) const {
  size_t best = scheduler.ready_at.size();
  bool best_fits = false;
  // Whether warp `a` is to blame rather than warp `b`.
  const auto before = [&](size_t a, size_t b) {
    const Cycle until_a = std::max(scheduler.ready_at[a], now),
                until_b = std::max(scheduler.ready_at[b], now);
    return until_a != until_b ? until_a < until_b : scheduler.age[a] < scheduler.age[b];
  };
  for (uint64_t rest = scheduler.resident; rest; rest &= rest - 1) {
    const auto i = size_t(std::countr_zero(rest));
    const bool fits = reason_of(scheduler, i, now) == scheduler.reason;
    if (best != scheduler.ready_at.size() && (fits != best_fits ? best_fits : !before(i, best))) continue;
    best = i;
    best_fits = fits;
  }
  if (best == scheduler.ready_at.size()) return Profile::kNowhere;
  const auto slot = uint32_t(best) * params_.schedulers + scheduler.index;
  return scheduler.reason == Stall::RtWait && scheduler.ready_at[best] == kNever ? rays_pc_[slot]
                                                                                 : warps_[slot].simt.pc;
}

}  // namespace glint::core
