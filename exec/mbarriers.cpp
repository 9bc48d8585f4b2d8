// Runs barriers in shared memory: arrivals, and questions whether a phase has ended.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <string>

#include "exec/launch.h"
#include "exec/memory_ops.h"
#include "isa/mbarrier.h"

namespace glint::exec {

using isa::Mbarrier;
using isa::MbarrierKind;
using isa::Space;

namespace {

uint64_t word_at(const std::byte* at) {
  uint64_t word = 0;
  std::memcpy(&word, at, sizeof word);
  return word;
}

// Returns the operand behind the address, which most kinds have: a count, a state or a parity.
uint64_t argument_of(const WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, int lane) {
  const size_t slot = isa::is_destination(row.operands.kind[0]) ? 2 : 1;
  if (slot >= row.operands.count) return 1;
  const bool is_wide = row.operands.kind[slot] == isa::OperandKind::Src64;
  return read_operand(warp.regs, inst.operand[slot], lane, is_wide ? 8 : 4);
}

// Says what is wrong with an operation, or nothing. Choice: PTX leaves open what happens then. An H200 ends
// the launch after too many arrivals, and goes on where there is no barrier.
std::string mistake_of(MbarrierKind kind, const Mbarrier& barrier, uint32_t count) {
  if (kind == MbarrierKind::Init)
    return count >= 1 && count <= Mbarrier::kMost
               ? ""
               : fmt::format("makes an mbarrier for {} arrivals, expected 1 to {}", count, Mbarrier::kMost);
  if (!barrier.is_there)
    return "uses an mbarrier that mbarrier.init has not made, or that mbarrier.inval has ended";
  if (kind == MbarrierKind::CopyArrive && barrier.pending == Mbarrier::kMost)
    return fmt::format("lets an mbarrier wait for more than {} arrivals", Mbarrier::kMost);
  const bool arrives = kind == MbarrierKind::Arrive || kind == MbarrierKind::ArriveDrop;
  if (arrives && count > barrier.pending)
    return fmt::format("arrives {} times at an mbarrier whose phase waits for {} arrivals", count,
                       barrier.pending);
  return "";
}

// Returns what an operation makes of a barrier.
Mbarrier after(MbarrierKind kind, Mbarrier barrier, uint32_t count) {
  switch (kind) {
    case MbarrierKind::Init:
      return {count, count, false, true};
    case MbarrierKind::Inval:
      return {};
    case MbarrierKind::CopyArrive:
      ++barrier.pending;
      return barrier;
    case MbarrierKind::ArriveDrop:
      barrier.expected -= count;
      [[fallthrough]];
    case MbarrierKind::Arrive:
      barrier.arrive(count);
      return barrier;
    case MbarrierKind::TestWait:
    case MbarrierKind::TryWait:
    case MbarrierKind::CopyArriveNoInc:
      return barrier;
  }
  return barrier;
}

}  // namespace

// Runs an mbarrier.*. Lanes take turns, the lowest first. Choice: PTX leaves their order open.
bool MemoryOps::run_mbarrier(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row,
                             LaneMask lanes) {
  LanePlaces at;
  LaneMask inside = lanes;
  if (!locate(warp, row, Space::Shared, inside, at)) return false;
  const auto kind = MbarrierKind(row.detail);
  const bool returns = row.operands.kind[0] == isa::OperandKind::Dst64;
  if (returns && inside != lanes) load_zeros(warp, inst, row.memory, lanes & ~inside);
  for (LaneMask rest = inside; rest; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const uint64_t word = word_at(at[size_t(lane)]);
    const auto count = uint32_t(argument_of(warp, inst, row, lane));
    const std::string mistake = mistake_of(kind, Mbarrier::of(word), count);
    if (!mistake.empty()) return faults_.fail(warp, lane, mistake);
    if (!isa::asks_for_phase(kind))
      put(*warp.block, at[size_t(lane)], after(kind, Mbarrier::of(word), count));
    if (!returns) continue;
    uint32_t* const to = warp.regs.write(inst.operand[0]);
    to[lane] = uint32_t(word);
    to[kLanes + lane] = uint32_t(word >> 32);
  }
  if (isa::asks_for_phase(kind)) ask(warp, inst, row, inside, at);
  if (!isa::waits_for_copies(kind) || arrives_late_) return true;
  const isa::Access places = warp.regs.access;
  return arrive_late(warp, warp.simt.pc, places, inside);
}

// Notes what has become of a barrier.
void MemoryOps::put(Block& block, std::byte* at, const Mbarrier& barrier) {
  const uint64_t before = word_at(at), word = barrier.word();
  changes_ += word != before;
  block.ended_phases += Mbarrier::of(before).is_there && Mbarrier::of(before).phase != barrier.phase;
  std::memcpy(at, &word, sizeof word);
}

// Answers whether phases have ended. A phase is that of an arrival's state, or one of a parity.
void MemoryOps::ask(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes,
                    const LanePlaces& at) {
  const bool has_state = row.operands.kind[2] == isa::OperandKind::Src64;
  LaneMask ended = 0;
  for_each_lane(lanes, [&](int lane) {
    const uint64_t argument = argument_of(warp, inst, row, lane);
    const bool phase = has_state ? Mbarrier::of(argument).phase : (argument & 1) != 0;
    ended |= LaneMask{Mbarrier::of(word_at(at[size_t(lane)])).phase != phase} << lane;
  });
  LaneMask& answer = warp.regs.predicate[inst.operand[0]];
  answer = (answer & ~warp.regs.exec) | ended;
  warp.waits_for_phase = ended != lanes;
}

bool MemoryOps::ask_again(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes) {
  LanePlaces at;
  LaneMask inside = lanes;
  warp.regs.exec = lanes;
  if (!locate(warp, row, Space::Shared, inside, at)) return false;
  ask(warp, inst, row, inside, at);
  return !warp.waits_for_phase;
}

bool MemoryOps::arrive_late(WarpContext& warp, uint32_t pc, const isa::Access& places, LaneMask lanes) {
  for (LaneMask rest = lanes; rest; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    std::byte* const at = warp.block->shared.data() + places.address[size_t(lane)];
    const Mbarrier barrier = Mbarrier::of(word_at(at));
    if (const std::string mistake = mistake_of(MbarrierKind::Arrive, barrier, 1); !mistake.empty())
      return faults_.fail({mistake, world_.image->place_of(pc), shader_thread_id(warp, lane), false});
    put(*warp.block, at, after(MbarrierKind::Arrive, barrier, 1));
  }
  return true;
}

}  // namespace glint::exec
