// One warp slot of a core: its warp, and what has to happen before the next instruction can issue.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/types.h"
#include "core/block_places.h"
#include "core/instruction_fetch.h"
#include "core/scheduler.h"
#include "core/scoreboard.h"
#include "core/sequence.h"
#include "exec/warp_context.h"

namespace glint::core {

// Issuing an instruction touches one slot, so all of its state lies together. What a scheduler scans in every
// cycle lies in the scheduler instead, as arrays over its warps.
struct WarpSlot {
  exec::WarpContext warp;
  Scoreboard scoreboard;
  Scoreboard::Ready front;  // Before this cycle the warp issues nothing, whatever its registers say.
  Sequence sequence;        // The sequence that the warp is in.
  uint32_t line = InstructionFetch::kNone;  // The line of instructions that the warp is in or waits for.
  bool waits_for_line = false;
  BlockPlace* home = nullptr;      // The place of the warp's block.
  Scheduler* scheduler = nullptr;  // The slot's scheduler, for ever.
  uint32_t local = 0;              // The number of the slot in its scheduler.
};

}  // namespace glint::core
