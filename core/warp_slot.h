// Holds one warp slot of a core: its warp, and what has to happen before its next instruction can issue.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "base/types.h"
#include "core/block_slots.h"
#include "core/instruction_fetch.h"
#include "core/scheduler.h"
#include "core/scoreboard.h"
#include "core/sequence.h"
#include "exec/warp_context.h"

namespace glint::core {

// Holds the state of one slot that issuing an instruction touches. What a scheduler scans in every cycle is
// in the scheduler instead, as arrays over its warps.
struct WarpState {
  exec::WarpContext warp;
  Scoreboard::Ready front;  // the warp issues nothing before this cycle, whatever its registers say
  Sequence sequence;        // the sequence that the warp is in
  uint32_t line = InstructionFetch::kNone;  // the line of instructions that the warp is in or waits for
  bool waits_for_line = false;
  BlockSlot* home = nullptr;       // the slot of the warp's block
  Scheduler* scheduler = nullptr;  // the slot's scheduler, which never changes
  uint32_t local = 0;              // the number of the slot in its scheduler
  // The mask of lanes that was counted last, and its lanes: most instructions have that of the one before.
  struct {
    LaneMask mask = 0;
    uint32_t lanes = 0;
  } counted;
  Scoreboard scoreboard;
};

// Choice: a slot takes an odd number of cache lines of the host, so that the same members of a core's warps
// lie in different sets of its caches.
struct WarpSlot : WarpState {
  static constexpr size_t kLine = 64;
  alignas(kLine) std::array<std::byte, kLine*(1 + sizeof(WarpState) / kLine % 2)> apart;
};
static_assert(sizeof(WarpSlot) / WarpSlot::kLine % 2 == 1);

}  // namespace glint::core
