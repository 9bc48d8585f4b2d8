// Records what the warps of one core do, as slices of a trace, within a window and a bound.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/trace_table.h"
#include "core/core_observer.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::core {

// Cuts slices at the window's ends. When the bound is reached, the window ends there, and every slice before
// is kept.
class TraceRecorder final : public CoreObserver {
 public:
  // Choice: what takes less than this many cycles counts as running, not as a wait of its own.
  static constexpr Cycle kShortWait = 4;

  // `room` is a number of slices, at least least_room(). Nothing is allocated later.
  TraceRecorder(const exec::Image& image, uint32_t warp_slots, uint32_t rt_slots, Cycle begin, Cycle end,
                uint64_t room);
  // Returns the slices that all tracks may still add after the window has ended.
  static uint64_t least_room(uint32_t warp_slots, uint32_t rt_slots) {
    return uint64_t{6} * warp_slots + 2 * rt_slots;
  }

  void start_warp(Cycle now, uint32_t slot, const exec::WarpContext& warp) override;
  void select(Cycle now, uint32_t slot, Cycle ready, Stall wait, Stall door, uint32_t pc) override;
  void issue(Cycle now, uint32_t slot, const exec::Issued& issued) override;
  void end_warp(Cycle now, uint32_t slot) override;
  // Notes that a warp enters a slot of the RT unit's warp buffer.
  void enter_rt(Cycle now, uint32_t rt_slot, uint32_t slot, LaneMask lanes, const rt::RayState* states);
  void leave_rt(Cycle now, uint32_t rt_slot, LaneMask lanes, const rt::RayState* states);

  Cycle end() const { return end_; }  // earlier than asked for when the bound was reached
  // Returns the slices in order of their ends, except for those that were open at the end.
  const std::vector<TraceSlice>& slices() const { return slices_; }

  // Returns TraceTable::states: "running", then the waits.
  static std::vector<std::string> state_names();

 private:
  struct Slot {
    uint32_t warp = 0, shader = 0;
    Cycle begin = 0;  // when the warp began
    Cycle stage_begin = 0;
    Cycle run_begin = 0;  // when the running state began, which lasts up to `known`
    Cycle known = 0;      // What came before is in a slice, or is running.
  };
  struct RtStay {
    Cycle begin = 0;
    uint32_t slot = 0, nodes = 0, triangle_tests = 0;
  };

  void wait(uint32_t slot, Stall reason, Cycle until);
  void enter_stage(uint32_t slot, uint32_t pc);
  void end_run(uint32_t slot, Cycle at);
  void add(const TraceSlice& slice);

  const exec::Image& image_;
  const Cycle begin_;
  Cycle end_;
  const uint64_t room_;
  std::vector<Slot> slots_;
  std::vector<RtStay> rt_stays_;
  std::vector<TraceSlice> slices_;
};

}  // namespace glint::core
