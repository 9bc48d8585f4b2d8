// Hands the rays of warps over from a core to its RT unit, and takes warps back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "core/core_parts.h"
#include "core/parking_lot.h"
#include "rtunit/rt_port.h"

namespace glint::core {

class RayDoor {
 public:
  // `parking` is null when warps keep their places.
  RayDoor(const CoreParts& core, rt::RtPort& rt, ParkingLot* parking)
      : core_(core), rt_(rt), parking_(parking), trips_(core.warps.size()) {}

  // Gives the rays of an rt.trace, rt.resume or rq.proceed to the RT unit. The warp goes on at once when none
  // of its rays has to travel.
  void start(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  // Lets warps go on whose rays have all stopped by `now`.
  void take_answers(Cycle now) {
    while (rt_.has_completion()) {
      const auto slot = rt_.pop_completion(now);
      if (!slot) return;
      if (!parking_ || parking_->come_back(*slot, now)) complete(*slot, now, 0);
    }
  }
  // Lets warps leave their places, and others return to these. It is called at the end of a cycle, and only
  // when there is parking.
  void let_return(Cycle now) {
    parking_->tick(now);
    while (const auto slot = parking_->give_place(now)) complete(*slot, now, parking_->latency());
  }
  // Returns the instruction that handed over the slot's rays last.
  uint32_t traced_at(uint32_t slot) const { return trips_[slot].pc; }

 private:
  struct Trip {
    Cycle issued = 0;
    uint32_t pc = 0;
    LaneMask lanes = 0;  // lanes whose rays travel
  };
  bool has_saved_registers(uint32_t pc) const;
  // `later` is the time that a warp takes to go on with its new place.
  void complete(uint32_t slot, Cycle now, Cycle later);

  const CoreParts core_;
  rt::RtPort& rt_;
  ParkingLot* const parking_;
  std::vector<Trip> trips_;  // the last trip of each slot
};

}  // namespace glint::core
