// Lets the diverged paths of a warp take turns.
// SPDX-License-Identifier: Apache-2.0
#include "core/subwarp_unit.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/num_lanes.h"

namespace glint::core {

using exec::SimtStack;

std::unique_ptr<SubwarpUnit> SubwarpUnit::make(const CoreParts& core) {
  auto policy = core.params.interleaving.make({&core.counts.stats});
  if (!policy->is_used()) return nullptr;
  return std::make_unique<SubwarpUnit>(core, std::move(policy));
}

SubwarpUnit::SubwarpUnit(const CoreParts& core, std::unique_ptr<Interleaving> policy)
    : core_(core), policy_(std::move(policy)), stats_(&core.counts.stats), slots_(core.warps.size()) {
  for (Slot& slot : slots_) slot.accesses.reserve(core.params.lsu.accesses);
}

void SubwarpUnit::begin(uint32_t slot, uint32_t access, uint32_t pc, LaneMask lanes) {
  slots_[slot].accesses.push_back({access, pc, lanes});
}

void SubwarpUnit::end(uint32_t slot, uint32_t access, Cycle ready) {
  Slot& of = slots_[slot];
  const auto at = std::ranges::find(of.accesses, access, &Access::number);
  const Access ended = *at;
  const LaneMask running = core_.warps[slot].warp.simt.active;
  of.accesses.erase(at);
  if (ended.lanes & ~running) of.ready = std::max(of.ready, ready);
  if (!(ended.lanes & running)) return;
  const IssueRow& row = core_.table.row(ended.pc);
  for (const uint16_t& def : core_.table.defs(row)) {
    // Lanes that have met may wait for several accesses that fill one register.
    if (fills(of, running, def))
      of.ready = std::max(of.ready, ready);
    else
      core_.warps[slot].scoreboard.set({&def, 1}, {std::max(ready, of.ready), row.wait});
  }
}

// Returns whether an access without an answer fills the register for some of the lanes.
bool SubwarpUnit::fills(const Slot& slot, LaneMask lanes, uint16_t def) const {
  return std::ranges::any_of(slot.accesses, [&](const Access& access) {
    const auto defs = core_.table.defs(core_.table.row(access.pc));
    return access.lanes & lanes && std::ranges::find(defs, def) != defs.end();
  });
}

void SubwarpUnit::yield(uint32_t slot, Cycle now) {
  WarpSlot& at = core_.warps[slot];
  const std::optional<size_t> path = offer(at, slots_[slot]);
  if (!path || !policy_->yields(view_of(at, *path))) return;
  ++stats_.yields;
  change(at, slots_[slot], *path, now);
}

void SubwarpUnit::look(Scheduler& scheduler, Cycle now) {
  for (uint64_t rest = waiting_of(scheduler); rest; rest &= rest - 1) {
    const auto local = uint32_t(std::countr_zero(rest));
    const uint32_t slot = core_.warps.slot_of(scheduler, local);
    WarpSlot& at = core_.warps[slot];
    const std::optional<size_t> path = offer(at, slots_[slot]);
    if (!path || !policy_->leaves(view_of(at, *path))) continue;
    ++stats_.stalls;
    change(at, slots_[slot], *path, now);
    core_.warps.refresh(at, now);
  }
}

// Returns the warps whose next instruction waits for an access without an answer.
uint64_t SubwarpUnit::waiting_of(const Scheduler& scheduler) const {
  uint64_t waiting = scheduler.waiting_for_memory();
  for (uint64_t rest = waiting; rest; rest &= rest - 1) {
    const auto local = uint32_t(std::countr_zero(rest));
    if (scheduler.next_of(local).ready_at != kNever) waiting &= ~(uint64_t{1} << local);
  }
  return waiting;
}

Interleaving::View SubwarpUnit::view_of(const WarpSlot& at, size_t path) const {
  const SimtStack& simt = at.warp.simt;
  return {uint32_t(num_lanes(simt.active)), uint32_t(num_lanes(simt.entries()[path].lanes)),
          uint32_t(std::popcount(at.scheduler->resident())),
          uint32_t(std::popcount(waiting_of(*at.scheduler)))};
}

// Returns the path that the warp could change to, which counts as a question, or none.
std::optional<size_t> SubwarpUnit::offer(const WarpSlot& at, const Slot& slot) {
  if (at.front.at == kNever || at.sequence.is_under_way()) return std::nullopt;
  const std::optional<size_t> path = next_path(at, slot);
  if (path) ++stats_.asked;
  return path;
}

// Returns the path that could issue in place of the running one: of those that have begun the first, or else
// the first that may begin.
std::optional<size_t> SubwarpUnit::next_path(const WarpSlot& at, const Slot& slot) const {
  const SimtStack& simt = at.warp.simt;
  std::optional<size_t> fresh;
  uint32_t begun = 1;
  for (size_t i = 0; i < simt.entries().size(); ++i) {
    const SimtStack::Entry& entry = simt.entries()[i];
    if (!simt.can_run(i) || !simt.is_in_frame(i)) continue;
    begun += entry.has_begun;
    if ((entry.has_begun || !fresh) && can_issue(entry, slot)) {
      if (entry.has_begun) return i;
      fresh = i;
    }
  }
  return begun < core_.params.subwarps.paths ? fresh : std::nullopt;
}

// Returns whether no register of the path's next instruction waits for an access.
bool SubwarpUnit::can_issue(const SimtStack::Entry& path, const Slot& slot) const {
  return std::ranges::none_of(core_.table.uses(core_.table.row(path.pc)),
                              [&](uint16_t use) { return fills(slot, path.lanes, use); });
}

void SubwarpUnit::change(WarpSlot& at, Slot& slot, size_t path, Cycle now) {
  SimtStack& simt = at.warp.simt;
  stats_.begun += !simt.entries()[path].has_begun;
  simt.switch_to(path);
  at.front = {std::max(at.front.at, now + core_.params.subwarps.latency), Stall::Branch};
  renew(at, slot);
}

// Lets the registers wait for the accesses of the lanes that run now.
void SubwarpUnit::renew(WarpSlot& at, Slot& slot) const {
  at.scoreboard.forget_accesses();
  for (const Access& access : slot.accesses) {
    const IssueRow& row = core_.table.row(access.pc);
    if (access.lanes & at.warp.simt.active) at.scoreboard.set(core_.table.defs(row), {kNever, row.wait});
  }
  if (at.front.at < slot.ready) at.front = {slot.ready, Stall::LongScoreboard};
}

}  // namespace glint::core
