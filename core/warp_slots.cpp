// Finds when the next instruction of each warp can issue.
// SPDX-License-Identifier: Apache-2.0
#include "core/warp_slots.h"

#include <algorithm>

#include "base/check.h"

namespace glint::core {
namespace {

uint32_t num_block_slots(uint32_t slots, const Params& params, const exec::World& world) {
  if (world.block_size[0] == 0) return slots;
  return std::min(params.blocks, slots / exec::warps_per_block(world));
}

}  // namespace

WarpSlots::WarpSlots(uint32_t size, const Params& params, const exec::World& world, const IssueTable& table,
                     InstructionFetch* fetch, const CoreObservers& observers)
    : params_(params),
      table_(table),
      observers_(observers),
      fetch_(fetch),
      holds_operands_(params.lsu.holds_operands()),
      is_plain_(params.pipe_crossing + params.guard_delay == 0 && params.write_order && !holds_operands_ &&
                !fetch),
      prologue_(params.prologue.instructions +
                (world.shared_bytes > 0 ? params.prologue.shared_instructions : 0)),
      alarms_(std::make_unique<Alarms>(params.schedulers)),
      slots_(size),
      blocks_(num_block_slots(size, params, world)) {
  GLINT_CHECK(size > 0, "no warp fits: check() reports this");
  GLINT_CHECK(blocks_.size() > 0, "no block fits: check_block() reports this");
  schedulers_.reserve(params.schedulers);
  for (uint32_t s = 0; s < params.schedulers; ++s) schedulers_.emplace_back(s, size, params, *alarms_);
  for (uint32_t slot = 0; slot < size; ++slot) {
    slots_[slot].scheduler = &schedulers_[slot % params.schedulers];
    slots_[slot].local = slot / params.schedulers;
    if (holds_operands_) slots_[slot].scoreboard.keep_reads();
  }
}

uint32_t WarpSlots::first_free() const {
  uint32_t slot = 0;
  while (is_resident(slot)) ++slot;
  return slot;
}

void WarpSlots::start(uint32_t slot, BlockSlot& home, Cycle ready, Cycle now) {
  WarpSlot& at = slots_[slot];
  at.home = &home;
  at.scoreboard.reset();
  at.line = InstructionFetch::kNone;
  at.waits_for_line = false;
  at.front = {ready, Stall::Dispatch};
  at.sequence = {prologue_};
  at.scheduler->add(at.local, num_launched_++);
  ++num_resident_;
  refresh(slot, now);
}

void WarpSlots::free(uint32_t slot, Cycle now) {
  WarpSlot& at = slots_[slot];
  at.scheduler->remove(at.local);
  --num_resident_;
  blocks_.leave(*at.home, now);
  observers_.tell([&](CoreObserver& observer) { observer.end_warp(now, slot); });
}

void WarpSlots::refresh_in_full(WarpSlot& at, Cycle now) {
  if (fetch_) come_to_line(at, now);
  if (at.sequence.is_under_way()) {
    // The rest of a sequence needs only an issue slot. It has no operands, and the memory pipe, which stands
    // for its pipe here, is never busy by itself.
    at.scheduler->set_next(at.local, {at.front.at, at.front.wait, Pipe::Memory, Door::None, nullptr});
    return;
  }
  const IssueRow& row = table_.row(at.warp.simt.pc);
  const Scoreboard::Ready ready = operands_ready(at, row);
  at.scheduler->set_next(at.local, {ready.at, ready.wait, row.pipe, row.door, &row});
}

Scoreboard::Ready WarpSlots::operands_ready(const WarpSlot& slot, const IssueRow& row) const {
  const Scoreboard& board = slot.scoreboard;
  const Cycle crossing = params_.pipe_crossing, guard = params_.guard_delay;
  const Cycle slack = row.finish == Finish::Fixed && !params_.write_order ? row.latency - 1 : 0;
  const auto uses = table_.uses(row);
  Scoreboard::Ready ready = crossing + guard > 0 ? board.ready(uses, slot.front, row, crossing, guard, slack)
                            : slack > 0 ? board.ready_in_order(uses.first(uses.size() - row.num_defs),
                                                               table_.defs(row), slot.front, row.latency)
                                        : board.ready(uses, slot.front);
  if (holds_operands_) ready = board.unread(table_.defs(row), ready);
  if (slot.waits_for_line && ready.at != kNever) ready = {kNever, Stall::NoInstruction};
  return ready;
}

// Follows the warp to the line of its next instruction, which may be another than before.
void WarpSlots::come_to_line(WarpSlot& slot, Cycle now) {
  const uint32_t line = fetch_->line_of(slot.warp.simt.pc);
  if (line == slot.line) return;
  slot.line = line;
  slot.waits_for_line = !fetch_->come_to(slot.scheduler->index(), line, now);
}

void WarpSlots::take_line(uint32_t scheduler, uint32_t line, Cycle now) {
  for (uint32_t slot = scheduler; slot < size(); slot += params_.schedulers) {
    if (!slots_[slot].waits_for_line || slots_[slot].line != line) continue;
    slots_[slot].waits_for_line = false;
    refresh(slot, now);
  }
}

}  // namespace glint::core
