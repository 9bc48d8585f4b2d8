// Declares the interface that hears what happens to the warps of one core, as its cell simulates it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "core/stall.h"
#include "exec/executor.h"

namespace glint::core {

// Contract:
//  - The events of a slot come in order of time: start_warp, then issues and rays, then end_warp. After
//    end_warp the slot may start another warp.
//  - select() comes before issue() of the same cycle. An issue slot of a sequence (docs/core.md) has only a
//    select().
//  - Every start_rays() has one end_rays() with the same lanes, before the warp's next issue.
//  - An observer only reads: what it hears changes no cycle, and it allocates nothing.
class CoreObserver {
 public:
  virtual ~CoreObserver() = default;
  // Tells that the warp holds the slot from cycle `now` on.
  virtual void start_warp(Cycle /*now*/, uint32_t /*slot*/, const exec::WarpContext&) {}
  // Tells that the instruction at `pc` of the warp is about to issue. It waited for `wait` until `ready`, and
  // then for its turn at `door` (Stall::Issued stands for the scheduler or a pipe).
  virtual void select(Cycle /*now*/, uint32_t /*slot*/, Cycle /*ready*/, Stall /*wait*/, Stall /*door*/,
                      uint32_t /*pc*/) {}
  // Tells that the instruction was executed.
  virtual void issue(Cycle /*now*/, uint32_t /*slot*/, const exec::Issued&) {}
  // Tells that lanes begin a shader of that stage, which another shader has called.
  virtual void call(uint32_t /*slot*/, isa::Stage, LaneMask) {}
  // Tell that the rays of these lanes travel from now on (start_rays) or have stopped (end_rays).
  virtual void start_rays(uint32_t /*slot*/, LaneMask, const rt::RayState*) {}
  virtual void end_rays(uint32_t /*slot*/, LaneMask, const rt::RayState*) {}
  // Tells that the threads of these lanes have changed places (core.reorder), before either warp issues
  // again.
  virtual void swap_threads(Cycle /*now*/, uint32_t /*slot_a*/, int /*lane_a*/, uint32_t /*slot_b*/,
                            int /*lane_b*/) {}
  // Tells that the warp has freed its slot: cycle `now` is no longer its own.
  virtual void end_warp(Cycle /*now*/, uint32_t /*slot*/) {}
};

// Holds all observers of a core.
class CoreObservers {
 public:
  void add(CoreObserver& observer) { list_.push_back(&observer); }
  bool empty() const { return list_.empty(); }
  template <class Event>
  void tell(Event&& event) const {
    if (!list_.empty()) [[unlikely]]
      for (CoreObserver* observer : list_) event(*observer);
  }

 private:
  std::vector<CoreObserver*> list_;
};

}  // namespace glint::core
