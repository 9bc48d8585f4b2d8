// Gathers warps, lets their threads change places, and charges the time that moving takes.
// SPDX-License-Identifier: Apache-2.0
#include "core/reorder_unit.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/num_lanes.h"
#include "exec/lane_moves.h"

namespace glint::core {
namespace {

std::vector<uint16_t> all_registers(uint32_t num_registers) {
  std::vector<uint16_t> out(num_registers + isa::kNumPredicates);
  std::iota(out.begin(), out.begin() + num_registers, uint16_t{0});
  std::iota(out.begin() + num_registers, out.end(), kFirstPredicate);
  return out;
}

}  // namespace

std::unique_ptr<ReorderUnit> ReorderUnit::make(const CoreParts& core, MemoryAccesses& memory) {
  if (core.params.reorder.make({})->where() == Reorder::Where::Nowhere) return nullptr;
  return std::make_unique<ReorderUnit>(core, memory, core.params.reorder.make({&core.counts.stats}));
}

ReorderUnit::ReorderUnit(const CoreParts& core, MemoryAccesses& memory, std::unique_ptr<Reorder> policy)
    : core_(core),
      memory_(memory),
      params_(core.params.reordering),
      policy_(std::move(policy)),
      stats_(&core.counts.stats),
      registers_(all_registers(core.world.image->num_registers)),
      slots_(core.warps.size()),
      batches_(core.warps.size()),
      regrouping_(core.warps.size()) {
  members_.reserve(slots_.size());
  warps_.reserve(slots_.size());
  distinct_.reserve(kLanes);
}

void ReorderUnit::come(uint32_t slot, const exec::Issued& issued, Cycle now) {
  const exec::ReorderCalls& said = core_.executor.reorder_calls();
  Slot& at = slots_[slot];
  at.came = now;
  at.ready = kNever;
  at.pc = issued.pc;
  at.bytes = 4 * said.live_registers() + said.stack_bytes();
  for_each_lane(issued.lanes,
                [&](int lane) { at.keys[size_t(lane)] = policy_->key(said.calls()[size_t(lane)]); });
  coming_ |= uint64_t{1} << slot;
  core_.warps[slot].front = {kNever, Stall::Barrier};
  ++stats_.warps;
  stats_.threads += uint64_t(num_lanes(issued.lanes));
}

Cycle ReorderUnit::next_event(Cycle now) const {
  if (!(coming_ | waiting_)) return kNever;
  if (waiting_ && all_wait()) return now + 1;
  Cycle next = kNever;
  for (uint64_t rest = coming_; rest; rest &= rest - 1) {
    const Slot& at = slots_[size_t(std::countr_zero(rest))];
    // A warp that has come in this cycle has not been looked at yet.
    next = std::min(next, at.came == now ? now + 1 : at.ready);
  }
  if (waiting_)
    for (const Batch& batch : batches_)
      if (batch.slots) next = std::min(next, batch.since + params_.timeout);
  return std::max(next, now + 1);
}

void ReorderUnit::run(Cycle now) {
  for (uint64_t rest = coming_; rest; rest &= rest - 1) {
    const auto slot = uint32_t(std::countr_zero(rest));
    Cycle& ready = slots_[slot].ready;
    ready = memory_.in_flight(slot) ? kNever
                                    : core_.warps[slot].scoreboard.ready(registers_, {0, Stall::Barrier}).at;
    if (ready <= now) join(slot, now);
  }
  const bool nobody_else = waiting_ && all_wait();
  for (Batch& batch : batches_) {
    if (!batch.slots) continue;
    const bool is_over = now >= batch.since + params_.timeout;
    if (is_over) ++stats_.timeouts;
    if (is_over || nobody_else) go(batch, now);
  }
}

void ReorderUnit::join(uint32_t slot, Cycle now) {
  coming_ &= ~(uint64_t{1} << slot);
  waiting_ |= uint64_t{1} << slot;
  Batch& batch = batch_of(slot);
  if (!batch.slots) batch.since = now;
  batch.slots |= uint64_t{1} << slot;
  Reorder::Waiting waiting{.batch = params_.batch};
  for (uint64_t rest = batch.slots; rest; rest &= rest - 1) {
    ++waiting.warps;
    waiting.threads += uint32_t(num_lanes(warp(uint32_t(std::countr_zero(rest))).simt.active));
  }
  if (policy_->goes(waiting)) go(batch, now);
}

// Returns the batch with whose warps the warp can exchange threads, or an empty one.
ReorderUnit::Batch& ReorderUnit::batch_of(uint32_t slot) {
  Batch* empty = nullptr;
  for (Batch& batch : batches_) {
    if (!batch.slots) {
      if (!empty) empty = &batch;
    } else if (exec::can_exchange(warp(uint32_t(std::countr_zero(batch.slots))), warp(slot))) {
      return batch;
    }
  }
  return *empty;
}

void ReorderUnit::go(Batch& batch, Cycle now) {
  members_.clear();
  uint32_t bytes = 0;
  for (uint64_t rest = batch.slots; rest; rest &= rest - 1) {
    members_.push_back(uint32_t(std::countr_zero(rest)));
    bytes = std::max(bytes, slots_[members_.back()].bytes);
  }
  waiting_ &= ~std::exchange(batch.slots, 0);
  ++stats_.batches;
  count_keys(stats_.keys_before, stats_.warps_before);
  const uint64_t moved = move_threads(now);
  count_keys(stats_.keys_after, stats_.warps_after);
  stats_.threads_moved += moved;
  stats_.bytes_moved += moved * bytes;
  const Cycle transfer = (moved * bytes + params_.bytes_per_cycle - 1) / params_.bytes_per_cycle;
  free_at_ = std::max(free_at_, now) + transfer;
  for (const uint32_t slot : members_) end_call(slot, free_at_ + params_.latency, now);
}

// Returns the number of threads that went to other warps.
uint64_t ReorderUnit::move_threads(Cycle now) {
  warps_.clear();
  for (const uint32_t slot : members_) {
    const exec::WarpContext& of = warp(slot);
    warps_.push_back({of.simt.active, exec::movable_lanes(of), of.simt.live(), slots_[slot].keys.data()});
  }
  for (const Regrouping::Swap& swap : regrouping_.plan(warps_, params_.compact)) {
    const uint32_t a = members_[swap.warp_a], b = members_[swap.warp_b];
    exec::swap_threads(warp(a), swap.lane_a, warp(b), swap.lane_b, *core_.world.image);
    std::swap(slots_[a].keys[swap.lane_a], slots_[b].keys[swap.lane_b]);
    core_.observers.tell(
        [&](CoreObserver& observer) { observer.swap_threads(now, a, swap.lane_a, b, swap.lane_b); });
  }
  return regrouping_.num_moved();
}

void ReorderUnit::count_keys(stats::Counter& keys, stats::Counter& warps) {
  for (const uint32_t slot : members_) {
    distinct_.clear();
    for_each_lane(warp(slot).simt.active,
                  [&](int lane) { distinct_.push_back(slots_[slot].keys[size_t(lane)]); });
    std::sort(distinct_.begin(), distinct_.end());
    keys += uint64_t(std::unique(distinct_.begin(), distinct_.end()) - distinct_.begin());
    warps += uint64_t{!distinct_.empty()};
  }
}

// Lets the warp go on at `done`, or ends it when no thread is left in it.
void ReorderUnit::end_call(uint32_t slot, Cycle done, Cycle now) {
  WarpSlot& at = core_.warps[slot];
  const Slot& call = slots_[slot];
  stats_.wait_cycles += now - call.came;
  stats_.move_cycles += done - now;
  core_.counts.end(call.pc, done - call.came);
  if (core_.counts.profile) core_.counts.profile->end(call.pc, done - call.came);
  ++core_.counts.progress;
  if (core_.executor.resume(at.warp)) {
    ++stats_.warps_ended;
    memory_.retire(slot, now);
    return;
  }
  at.front = {done, Stall::Barrier};
  core_.warps.refresh(slot, now);
}

}  // namespace glint::core
