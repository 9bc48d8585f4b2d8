// Lets warps leave their places and return to them.
// SPDX-License-Identifier: Apache-2.0
#include "core/parking_lot.h"

#include <utility>

namespace glint::core {

std::unique_ptr<ParkingLot> ParkingLot::make(const CoreParts& core, const MemoryAccesses& memory,
                                             uint32_t places) {
  auto policy = core.params.parking.make({&core.counts.stats});
  if (!policy->is_used()) return nullptr;
  return std::make_unique<ParkingLot>(core, memory, places, std::move(policy));
}

ParkingLot::ParkingLot(const CoreParts& core, const MemoryAccesses& memory, uint32_t places,
                       std::unique_ptr<Parking> policy)
    : core_(core),
      memory_(memory),
      places_(places),
      policy_(std::move(policy)),
      stats_(&core.counts.stats),
      slots_(core.warps.size()),
      returning_(core.warps.size()) {
  waiting_.reserve(slots_.size());
  leaving_.reserve(slots_.size());
}

void ParkingLot::start(uint32_t slot, uint32_t lanes, Cycle now) {
  slots_[slot] = {.state = State::Waiting, .lanes = lanes};
  if (!ask(slot, now)) waiting_.push_back(slot);
}

bool ParkingLot::ask(uint32_t slot, Cycle now) {
  ++stats_.asked;
  if (!policy_->gives_up({now, slots_[slot].lanes, places_, num_held(), num_parked_,
                          uint32_t(returning_.size()), has_blocks_}))
    return false;
  slots_[slot].state = State::Leaving;
  leaving_.push_back(slot);
  return true;
}

void ParkingLot::leave(Cycle now) {
  std::erase_if(leaving_, [&](uint32_t slot) {
    if (memory_.in_flight(slot)) return false;
    slots_[slot].state = State::Away;
    slots_[slot].since = now;
    ++num_parked_;
    ++stats_.left;
    return true;
  });
}

bool ParkingLot::come_back(uint32_t slot, Cycle now) {
  Slot& at = slots_[slot];
  if (at.state != State::Away) {
    if (at.state == State::Waiting) std::erase(waiting_, slot);
    if (at.state == State::Leaving) std::erase(leaving_, slot);
    at.state = State::Here;
    return true;
  }
  at.state = State::Returning;
  at.rays_at = now;
  returning_.push(slot);
  core_.warps[slot].front = {kNever, Stall::Dispatch};
  core_.warps.refresh(slot, now);
  if (num_held() - leaving_.size() == places_ && !waiting_.empty() && ask(waiting_.back(), now))
    waiting_.pop_back();
  return false;
}

std::optional<uint32_t> ParkingLot::give_place(Cycle now) {
  if (returning_.empty() || num_held() == places_) return std::nullopt;
  const uint32_t slot = returning_.front();
  returning_.pop();
  Slot& at = slots_[slot];
  at.state = State::Here;
  --num_parked_;
  stats_.parked_cycles += now - at.since;
  stats_.wait_cycles += now - at.rays_at;
  return slot;
}

}  // namespace glint::core
