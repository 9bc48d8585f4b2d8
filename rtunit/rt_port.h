// The door between a core and its RT unit: rays go in by warp, "done" and "needs a shader" come out by warp.
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
//  - submit() is called only when can_accept(); the unit then works on `states[lane]` for the lanes of
//  `mask`,
//    all of which are Traversing, until each is Done, needs a shader or has Gathered candidates; the storage
//    stays the caller's and is not touched by it meanwhile.
//  - exactly one completion comes back for each submit, at a later cycle.
//  - a warp that needs shaders is given back whole; the core runs them, resolves the candidates
//    (RayState::accept, ignore, terminate) and submits the still Traversing lanes again.
class RtPort {
 public:
  virtual ~RtPort() = default;
  virtual bool can_accept() const = 0;
  virtual void submit(Cycle now, uint32_t warp_slot, LaneMask mask, RayState* states) = 0;
  // A warp slot whose rays have all stopped, if one has by `now`; each is returned once.
  virtual std::optional<uint32_t> pop_completion(Cycle now) = 0;
  // Advances to `now`. Called every cycle that the core does not skip.
  virtual void tick(Cycle now) = 0;
  // Earliest cycle after `now` at which tick() can do anything without new input; kNever when idle.
  virtual Cycle next_event(Cycle now) const = 0;
  // Lines on the warps inside and what they wait for, for a machine that is stuck; "" when there is nothing
  // to say.
  virtual std::string describe() const { return {}; }
};

}  // namespace glint::rt
