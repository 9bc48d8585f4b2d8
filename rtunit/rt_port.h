// Declares the door between a core and its RT unit: warps go in with their rays and come out when all rays
// have stopped.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "base/types.h"
#include "rtunit/traversal/ray.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::rt {

// Contract (tests/contract/rt_port_test.cpp):
//  - submit() is called only when can_accept(). The lanes of `mask` are all Traversing; the unit works on
//    their `states[lane]` until each is Done, needs a shader or has Gathered candidates. The caller keeps the
//    storage and does not touch it meanwhile.
//  - Exactly one completion comes back for each submit, at a later cycle.
//  - The unit calls set_room() and set_completion() whenever the answer of can_accept() or has_completion()
//    changes. has_completion() may hold while no warp comes back, but not the other way round.
//  - A unit that never calls set_due() is due in every cycle.
//  - A warp that needs shaders is given back whole. The core runs them, decides the candidates
//    (accept_candidate() and the others of traversal.h) and submits the lanes that still traverse again.
class RtPort {
 public:
  virtual ~RtPort() = default;
  // Returns whether the unit takes another warp. It is no virtual call, because schedulers ask in every
  // cycle.
  bool can_accept() const { return has_room_; }
  virtual void submit(Cycle now, uint32_t warp_slot, LaneMask mask, RayState* states) = 0;
  // Returns whether pop_completion() may return a warp slot. The core asks in every cycle.
  bool has_completion() const { return has_completion_; }
  // Returns a warp slot whose rays have all stopped by `now`, if there is one; each is returned once.
  virtual std::optional<uint32_t> pop_completion(Cycle now) = 0;
  // Returns whether tick() may have something to do, unless the L1 has an answer. It is no virtual call,
  // because the core asks in every cycle.
  bool is_due(Cycle now) const { return due_ <= now; }
  // Advances to `now`. The core calls it in every cycle in which is_due() holds or the L1 has an answer.
  virtual void tick(Cycle now) = 0;
  // Returns the earliest cycle after `now` in which tick() can do anything without new input, or kNever when
  // the unit is idle.
  virtual Cycle next_event(Cycle now) const = 0;
  // Returns lines that say which warps are inside and what they wait for, for a machine that is stuck. The
  // text is empty when the unit is.
  virtual std::string describe() const { return {}; }

 protected:
  RtPort() = default;
  RtPort(const RtPort&) = delete;
  RtPort& operator=(const RtPort&) = delete;
  void set_room(bool has_room) { has_room_ = has_room; }
  void set_completion(bool has_completion) { has_completion_ = has_completion; }
  // Sets and returns the first cycle with work of the unit's own.
  void set_due(Cycle due) { due_ = due; }
  Cycle due() const { return due_; }

 private:
  bool has_room_ = false, has_completion_ = false;
  Cycle due_ = 0;
};

}  // namespace glint::rt
