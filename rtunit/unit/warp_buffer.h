// Holds the warps that are in the RT unit, and what each of their lanes does.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "base/probe.h"
#include "memsys/ring.h"
#include "rtunit/intersection/four.h"
#include "rtunit/params.h"
#include "rtunit/traversal/ray_state.h"
#include "rtunit/unit/read.h"
#include "rtunit/unit/rt_stats.h"

namespace glint::rt {

// Tells that a warp takes a slot of the warp buffer, or frees it (`has_left`).
struct WarpMoved {
  Cycle cycle = 0;
  uint32_t buffer_slot = 0, warp_slot = 0;
  bool has_left = false;
  LaneMask lanes = 0;
  const RayState* states = nullptr;
};

// Names a thread of the core.
struct Thread {
  uint32_t warp_slot = 0;
  int lane = 0;
};

// Holds one warp in the buffer. At any time a lane of `mask` either wants a read, waits for one, is in a test
// or has stopped.
struct BufferSlot {
  bool is_used = false;
  uint32_t warp_slot = 0;  // the core's warp slot
  LaneMask mask = 0, wanting = 0, stopped = 0;
  RayState* states = nullptr;
  // Lanes in `helping` work on parts of other lanes' rays, which lie in `parts`; WorkSharing decides. Each
  // has the lane whose ray it is in `owner`.
  LaneMask helping = 0;
  RayState* parts = nullptr;
  std::array<uint8_t, kLanes> owner{};
  // The threads whose rays the lanes have, by lane. Null: they are the threads of `warp_slot`.
  const Thread* threads = nullptr;
  uint64_t age = 0;  // order of arrival
  Cycle arrived = 0;
  uint32_t unsent_writes = 0;     // The warp stays until the L1 has taken them.
  size_t next_exit = 0;           // first of the buffer's exits that the warp has not passed
  std::array<Read, kLanes> read;  // reads of the lanes that want one, wait for one or are in a test
  // These are the low words of the reads' addresses. They mostly tell two nodes apart and are compared at
  // once.
  alignas(FourBits) std::array<uint32_t, kLanes> low_address{};

  bool is_helping(int lane) const { return helping >> lane & 1; }
  // Returns the ray that a lane works on, or the part of one.
  RayState& ray_of(int lane) const {
    if (is_helping(lane)) [[unlikely]]
      return parts[lane];
    return states[lane];
  }
  // Returns the lane whose ray a lane works for.
  int owner_of(int lane) const { return is_helping(lane) ? owner[size_t(lane)] : lane; }
  // Returns the thread whose own ray has the lane.
  Thread place_of(int lane) const { return threads ? threads[lane] : Thread{warp_slot, lane}; }
  // Returns the thread whose ray a lane works for.
  Thread thread_of(int lane) const { return place_of(owner_of(lane)); }
  LaneMask owners_of(LaneMask lanes) const {
    LaneMask out = lanes & ~helping;
    for_each_lane(lanes & helping, [&](int lane) { out |= LaneMask{1} << owner[size_t(lane)]; });
    return out;
  }
  bool is_done() const { return stopped == mask && unsent_writes == 0; }
};

// Stands between the stop of a warp's last lane and its return to the core.
class WarpExit {
 public:
  virtual ~WarpExit() = default;
  // Returns whether the warp must stay. The exit then calls WarpBuffer::leave() when the warp may go on.
  virtual bool holds(uint32_t slot, Cycle now) = 0;
};

class WarpBuffer {
 public:
  WarpBuffer(const Params& params, RtStats& stats);
  // Adds an exit. A warp passes the exits in the order in which they were added.
  void add(WarpExit& exit) { exits_.push_back(&exit); }

  bool has_room() const { return num_resident_ < slots_.size() && num_rays_ < most_rays_; }
  // Returns whether a lane has become free since the last call, where rt.oracle.any_lane makes that room.
  bool take_opened() { return std::exchange(opened_, false); }
  // Returns the slot that the warp takes.
  uint32_t admit(Cycle now, uint32_t warp_slot, LaneMask mask, RayState* states);
  BufferSlot& operator[](uint32_t slot) { return slots_[slot]; }
  const BufferSlot& operator[](uint32_t slot) const { return slots_[slot]; }
  uint32_t size() const { return uint32_t(slots_.size()); }

  void want(uint32_t slot, int lane, const Fetch& what, Pipe pipe, WalkHook* errand = nullptr) {
    BufferSlot& at = slots_[slot];
    at.read[size_t(lane)].set(what, pipe, errand);
    at.low_address[size_t(lane)] = uint32_t(what.address);
    at.wanting |= LaneMask{1} << lane;
    wanting_ |= uint64_t{1} << slot;
    note_change(slot);
  }
  // Notes that the lanes' reads are under way.
  void serve(uint32_t slot, LaneMask lanes) {
    slots_[slot].wanting &= ~lanes;
    if (slots_[slot].wanting == 0) wanting_ &= ~(uint64_t{1} << slot);
    note_change(slot);
  }
  // Returns the slots, as a mask, whose warp or wanting lanes have changed since the last call.
  uint64_t take_changes() { return std::exchange(changed_, 0); }
  void note_change(uint32_t slot) { changed_ |= uint64_t{1} << slot; }
  void stop(uint32_t slot, int lane, Cycle now);
  // Takes a lane out of its warp whose ray is between two nodes.
  void withdraw(uint32_t slot, int lane, Cycle now);
  void add_writes(uint32_t slot, uint32_t count) { slots_[slot].unsent_writes += count; }
  void write_sent(uint32_t slot, Cycle now);
  // Lets the warp pass the exits that it has not passed yet.
  void leave(uint32_t slot, Cycle now);
  // Gives back warps that left in earlier cycles, so a slot that becomes free now is usable from now on.
  void retire(Cycle now) {
    if (!finished_.empty()) [[unlikely]]
      retire_finished(now);
  }
  std::optional<uint32_t> pop_completion() {
    if (completions_.empty()) return std::nullopt;
    const uint32_t warp_slot = completions_.front();
    completions_.pop();
    return warp_slot;
  }

  bool has_leaving_warps() const { return !finished_.empty() || !completions_.empty(); }
  bool has_completion() const { return !completions_.empty(); }
  bool has_wanting_lanes() const { return wanting_ != 0; }
  uint32_t num_resident() const { return num_resident_; }
  uint32_t num_rays() const { return num_rays_; }  // rays that have not stopped
  Probe<WarpMoved>& warp_moved() { return warp_moved_; }

 private:
  void retire_finished(Cycle now);

  const uint32_t retires_per_cycle_;
  RtStats& stats_;
  Probe<WarpMoved> warp_moved_;
  const uint32_t most_rays_;  // With this number of rays or more the buffer takes no warp.
  std::vector<BufferSlot> slots_;
  uint64_t wanting_ = 0;  // bit i: some lane of slot i wants a read
  uint64_t changed_ = 0;  // bit i: take_changes() tells of slot i
  std::vector<WarpExit*> exits_;
  mem::Ring<uint32_t> finished_;     // slots whose warps have passed all exits
  mem::Ring<uint32_t> completions_;  // the core's warp slots, to be given back
  uint32_t num_resident_ = 0, num_rays_ = 0;
  bool opened_ = false;
  uint64_t next_age_ = 0;
};

}  // namespace glint::rt
