// Runs barriers: warps of a block wait for each other, and those that wait in vain are a fault.
// SPDX-License-Identifier: Apache-2.0
#include "exec/barriers.h"

#include <bit>
#include <fmt/format.h>
#include <map>
#include <string>
#include <utility>

#include "base/num_lanes.h"
#include "exec/launch.h"
#include "isa/barrier.h"

namespace glint::exec {

using isa::BarrierKind;

namespace {

// Names the operands after the results: the slots of the barrier's number, of the number of threads, and of
// the predicate of bar.red.
struct BarrierSlots {
  size_t barrier, threads, predicate;
};
BarrierSlots slots_of(BarrierKind kind) {
  const size_t first = kind == BarrierKind::Sync || kind == BarrierKind::Arrive ? 0 : 1;
  return {first, first + 1, first + 2};
}

bool is_uniform(const uint32_t* row, LaneMask lanes) {
  bool same = true;
  for_each_lane(lanes, [&](int lane) { same &= row[lane] == row[std::countr_zero(lanes)]; });
  return same;
}

}  // namespace

// A fault of a part of a warp. Where faults are let pass, the part arrives for the whole warp.
bool Barriers::come_divided(const WarpContext& warp, const isa::OpRow& row) {
  const LaneMask exec = warp.regs.exec;
  bool goes_on = true;
  for_each_lane(exec, [&](int lane) {
    goes_on = goes_on && faults_.let_pass(warp, lane, FaultKind::Barrier, [&] {
      return fmt::format("{} of the {} lanes of the warp come to {}, but all have to come together",
                         num_lanes(exec), num_lanes(warp.simt.live()), row.name);
    });
  });
  return goes_on;
}

// Model: only whole warps arrive. PTX leaves undefined what a warp does that is divided at a bar.sync
// (hardware from Volta on counts its threads one by one). Here a divided warp is a fault, and where faults
// are let pass, each part of the warp that comes counts as the warp, as on hardware before Volta.
bool Barriers::run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const LaneMask exec = warp.regs.exec;
  const auto kind = BarrierKind(row.detail);
  if (exec == 0) return ++warp.simt.pc, true;
  const int lane = std::countr_zero(exec);
  if (exec != warp.simt.live() && !come_divided(warp, row)) return false;
  const BarrierSlots slots = slots_of(kind);
  const uint32_t* const barriers = warp.regs.read(inst.operand[slots.barrier]);
  const uint32_t* const counts = warp.regs.read(inst.operand[slots.threads]);
  if (!is_uniform(barriers, exec) || !is_uniform(counts, exec))
    return faults_.fail(
        warp, lane, "the lanes of a warp come to different barriers, or expect different numbers of threads");
  const uint32_t barrier = barriers[lane], threads = counts[lane];
  if (!check(warp, barrier, threads)) return false;
  Block& block = *warp.block;
  const bool waits = kind != BarrierKind::Arrive;
  if (!waits && threads == 0)
    return faults_.fail(warp, lane, "bar.arrive has to say how many threads the barrier expects");
  if (!block.arrive(barrier, warp.warp_in_block, threads / uint32_t(kLanes), waits))
    return faults_.fail(
        warp, lane,
        fmt::format("comes to barrier {} for {} threads, and others wait there for another number", barrier,
                    threads));
  if (kind != BarrierKind::Sync && waits)
    block.contribute(barrier, num_lanes(exec),
                     num_lanes(exec & warp.regs.predicate[inst.operand[slots.predicate]]));
  if (waits) {
    warp.waiting_at_barrier = true;
    warp.barrier = barrier;
    warp.barrier_pc = warp.simt.pc;
    warp.barrier_lanes = exec;
  }
  ++warp.simt.pc;
  if (block.is_complete(barrier)) open(block, barrier);
  return !block.is_stuck() || fail_stuck(block);
}

bool Barriers::check(WarpContext& warp, uint32_t barrier, uint32_t threads) {
  const int lane = std::countr_zero(warp.regs.exec);
  if (barrier >= isa::kNumBarriers)
    return faults_.fail(warp, lane,
                        fmt::format("comes to barrier {}, and a block has {}", barrier, isa::kNumBarriers));
  const uint32_t most = warp.block->num_warps() * uint32_t(kLanes);
  if (threads % uint32_t(kLanes) != 0 || threads > most)
    return faults_.fail(
        warp, lane,
        fmt::format("comes to a barrier for {} threads, expected a multiple of {} up to the block's {}",
                    threads, kLanes, most));
  return true;
}

void Barriers::open(Block& block, uint32_t barrier) {
  const Barrier seen = block.release(barrier);
  for (WarpMask rest = seen.waiting; rest; rest &= rest - 1) {
    WarpContext& warp = *block.warps[size_t(std::countr_zero(rest))];
    warp.waiting_at_barrier = false;
    const isa::Inst& inst = world_.image->code[warp.barrier_pc].inst;
    const auto kind = BarrierKind(world_.image->code[warp.barrier_pc].row->detail);
    if (kind == BarrierKind::Count) {
      uint32_t* const to = warp.regs.write(inst.operand[0]);
      for_each_lane(warp.barrier_lanes, [&](int lane) { to[lane] = seen.count; });
    } else if (kind == BarrierKind::And || kind == BarrierKind::Or) {
      const bool value = kind == BarrierKind::And ? seen.count == seen.threads : seen.count != 0;
      LaneMask& predicate = warp.regs.predicate[inst.operand[0]];
      predicate = value ? predicate | warp.barrier_lanes : predicate & ~warp.barrier_lanes;
    }
  }
}

// Notes that the warp has ended. Barriers that wait for all warps may be complete without it.
bool Barriers::end_warp(WarpContext& warp) {
  Block& block = *warp.block;
  block.end(warp.warp_in_block);
  if (block.waiting() == 0) return true;
  for (uint32_t barrier = 0; barrier < isa::kNumBarriers; ++barrier)
    if (block.is_complete(barrier)) open(block, barrier);
  return !block.is_stuck() || fail_stuck(block);
}

bool Barriers::fail_stuck(const Block& block) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> waiting;  // maps instruction and barrier to warps
  const WarpContext* first = nullptr;
  for (WarpMask rest = block.waiting(); rest; rest &= rest - 1) {
    const WarpContext& warp = *block.warps[size_t(std::countr_zero(rest))];
    if (!first) first = &warp;
    ++waiting[{warp.barrier_pc, warp.barrier}];
  }
  std::string what = "a barrier that nobody can complete: ";
  for (const auto& [at, warps] : waiting)
    what += fmt::format("{} of {} warps wait at {} {} ({}), ", warps, block.num_warps(),
                        world_.image->code[at.first].row->name, at.second, world_.image->place_of(at.first));
  const bool ended = uint32_t(std::popcount(block.live())) < block.num_warps();
  what += ended ? "the others have ended" : "no other is left";
  return faults_.fail({std::move(what), world_.image->place_of(first->barrier_pc),
                       shader_launch_id(world_, first->warp_index, 0), true});
}

}  // namespace glint::exec
