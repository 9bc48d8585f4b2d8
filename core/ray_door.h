// Hands the rays of warps over from a core to its RT unit, and takes warps back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "core/core_parts.h"
#include "rtunit/rt_port.h"

namespace glint::core {

class RayDoor {
 public:
  RayDoor(const CoreParts& core, rt::RtPort& rt) : core_(core), rt_(rt), trips_(core.warps.size()) {}

  // Gives the rays of an rt.trace, rt.resume or rq.proceed to the RT unit. The warp goes on at once when none
  // of its rays has to travel.
  void start(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  // Lets warps go on whose rays have all stopped by `now`.
  void take_answers(Cycle now) {
    while (const auto slot = rt_.pop_completion(now)) complete(*slot, now);
  }
  // Returns the instruction that handed over the slot's rays last.
  uint32_t traced_at(uint32_t slot) const { return trips_[slot].pc; }

 private:
  struct Trip {
    Cycle issued = 0;
    uint32_t pc = 0;
    LaneMask lanes = 0;  // lanes whose rays travel
  };
  void complete(uint32_t slot, Cycle now);

  const CoreParts core_;
  rt::RtPort& rt_;
  std::vector<Trip> trips_;  // the last trip of each slot
};

}  // namespace glint::core
