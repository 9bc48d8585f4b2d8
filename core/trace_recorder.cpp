// Makes slices of a trace from what a core's warps do.
// SPDX-License-Identifier: Apache-2.0
#include "core/trace_recorder.h"

#include <algorithm>

#include "base/check.h"
#include "base/num_lanes.h"

namespace glint::core {
namespace {

constexpr uint32_t kRunning = 0;

// Returns whether a wait counts as running. Results of pipes come in a known, short time, so a warp that
// waits for one runs.
bool is_part_of_running(Stall reason) {
  switch (reason) {
    case Stall::Issued:
    case Stall::MathThrottle:
    case Stall::RegisterBanks:
    case Stall::RawFixed:
    case Stall::OperandRead:
    case Stall::RawSfu:
    case Stall::Branch:
      return true;
    default:
      return false;
  }
}

struct RayTotals {
  uint32_t nodes = 0, triangle_tests = 0;
};
RayTotals totals_of(LaneMask lanes, const rt::RayState* states) {
  RayTotals sum;
  for_each_lane(lanes, [&](int lane) {
    sum.nodes += states[lane].nodes_visited;
    sum.triangle_tests += states[lane].triangle_tests;
  });
  return sum;
}

}  // namespace

std::vector<std::string> TraceRecorder::state_names() {
  std::vector<std::string> names;
  for (size_t i = 0; i < size_t(Stall::Count); ++i)
    names.emplace_back(i == kRunning ? "running" : name_of(Stall(i)));
  return names;
}

TraceRecorder::TraceRecorder(const exec::Image& image, uint32_t warp_slots, uint32_t rt_slots, Cycle begin,
                             Cycle end, uint64_t room)
    : image_(image),
      begin_(begin),
      end_(end),
      room_(room - least_room(warp_slots, rt_slots)),
      slots_(warp_slots),
      rt_stays_(rt_slots) {
  static_assert(size_t(Stall::Issued) == kRunning);
  GLINT_CHECK(room >= least_room(warp_slots, rt_slots), "room for {} slices", room);
  slices_.reserve(room);
}

void TraceRecorder::start_warp(Cycle now, uint32_t slot, const exec::WarpContext& warp) {
  slots_[slot] = {warp.warp_index, image_.shader_of[warp.simt.pc], now, now, now, now};
}

// Notes a wait. It is part of the stage whose instruction waits. A wait for rays is part of the stage that
// traced them.
void TraceRecorder::select(Cycle now, uint32_t slot, Cycle ready, Stall reason, Stall door, uint32_t pc) {
  if (reason != Stall::RtWait) enter_stage(slot, pc);
  wait(slot, reason, std::min(ready, now));
  enter_stage(slot, pc);
  wait(slot, door, now);
}

// Notes that the warp is in the shader of this instruction since the end of what is known.
void TraceRecorder::enter_stage(uint32_t slot, uint32_t pc) {
  Slot& warp = slots_[slot];
  const uint32_t shader = image_.shader_of[pc];
  if (shader == warp.shader) return;
  end_run(slot, warp.known);
  add({warp.stage_begin, warp.known, slot, TraceKind::Stage, warp.shader, {}});
  warp.stage_begin = warp.known;
  warp.shader = shader;
}

// Notes that the warp waits from the end of what is known up to `until`.
void TraceRecorder::wait(uint32_t slot, Stall reason, Cycle until) {
  Slot& warp = slots_[slot];
  if (until <= warp.known) return;
  if (!is_part_of_running(reason) && until - warp.known >= kShortWait) {
    end_run(slot, warp.known);
    add({warp.known, until, slot, TraceKind::State, uint32_t(reason), {}});
    warp.run_begin = until;
  }
  warp.known = until;
}

void TraceRecorder::end_run(uint32_t slot, Cycle at) {
  Slot& warp = slots_[slot];
  add({warp.run_begin, at, slot, TraceKind::State, kRunning, {}});
  warp.run_begin = at;
}

void TraceRecorder::issue(Cycle now, uint32_t slot, const exec::Issued&) {
  slots_[slot].known = now + 1;
}

void TraceRecorder::end_warp(Cycle now, uint32_t slot) {
  Slot& warp = slots_[slot];
  wait(slot, Stall::Drain, now);
  end_run(slot, now);
  add({warp.stage_begin, now, slot, TraceKind::Stage, warp.shader, {}});
  add({warp.begin, now, slot, TraceKind::Warp, warp.warp, {}});
}

void TraceRecorder::enter_rt(Cycle now, uint32_t rt_slot, uint32_t slot, LaneMask lanes,
                             const rt::RayState* states) {
  const RayTotals before = totals_of(lanes, states);
  rt_stays_[rt_slot] = {now, slot, before.nodes, before.triangle_tests};
}

void TraceRecorder::leave_rt(Cycle now, uint32_t rt_slot, LaneMask lanes, const rt::RayState* states) {
  const RtStay& at = rt_stays_[rt_slot];
  const RayTotals after = totals_of(lanes, states);
  add({at.begin,
       now,
       rt_slot,
       TraceKind::Rays,
       num_lanes(lanes),
       {at.slot, after.nodes - at.nodes, after.triangle_tests - at.triangle_tests}});
}

void TraceRecorder::add(const TraceSlice& slice) {
  TraceSlice kept = slice;
  kept.begin = std::max(kept.begin, begin_);
  kept.end = std::min(kept.end, end_);
  if (kept.begin >= kept.end) return;
  slices_.push_back(kept);
  if (slices_.size() == room_) end_ = kept.end;
}

}  // namespace glint::core
