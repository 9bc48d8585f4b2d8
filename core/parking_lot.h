// Keeps account of the warps of a core that have no place, because their rays are in the RT unit.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/core_parts.h"
#include "core/memory_accesses.h"
#include "core/parking.h"
#include "memsys/ring.h"

namespace glint::core {

struct ParkingStats : stats::Group {
  explicit ParkingStats(Group* parent) : Group(parent, "parking") {}

  stats::Counter asked{this, "asked", "warp", "Number of times that a warp could have given up its place."};
  stats::Counter left{this, "left", "warp", "Number of times that a warp left its place."};
  stats::Counter parked_cycles{this, "parked_cycles", "warp-cycle",
                               "Cycles from leaving a place to having one again, summed over returns."};
  stats::Counter wait_cycles{
      this, "wait_cycles", "warp-cycle",
      "Cycles from the return of a warp's rays to having a place again, summed over returns."};
};

// A place is what a running warp holds: its registers. A warp at rt.trace or rt.resume has all of its live
// values on its stack already (docs/abi.md), so nothing has to be saved but the stack pointers.
//
// Model: stack pointers, program counters and SIMT stacks of parked warps stay in a table of the core.
// Reading the pointers back is part of ParkingLotParams::latency, and takes nothing from the L1.
class ParkingLot {
 public:
  // Returns null when the policy lets no warp leave.
  static std::unique_ptr<ParkingLot> make(const CoreParts& core, const MemoryAccesses& memory,
                                          uint32_t places);
  ParkingLot(const CoreParts& core, const MemoryAccesses& memory, uint32_t places,
             std::unique_ptr<Parking> policy);

  // Notes that the RT unit has taken rays of the warp.
  void start(uint32_t slot, uint32_t lanes, Cycle now);
  // Notes that the warp's rays are back. Returns whether it has its place still, so that it can go on.
  bool come_back(uint32_t slot, Cycle now);
  // Lets warps leave whose accesses have been answered. It is called after everything that answers these.
  void tick(Cycle now) {
    if (!leaving_.empty()) leave(now);
  }
  // Gives a free place to the warp that has waited longest, and returns its slot, or none.
  std::optional<uint32_t> give_place(Cycle now);
  // Notes that all blocks of the launch have begun.
  void end_of_blocks() { has_blocks_ = false; }

  uint32_t num_parked() const { return num_parked_; }
  Cycle latency() const { return core_.params.parking_lot.latency; }

 private:
  // A warp in Waiting has a place, and its rays are in the RT unit.
  enum class State : uint8_t { Here, Waiting, Leaving, Away, Returning };
  struct Slot {
    State state = State::Here;
    uint32_t lanes = 0;  // rays in the RT unit
    Cycle since = 0;     // when it left
    Cycle rays_at = 0;   // when its rays were back
  };
  uint32_t num_held() const { return core_.warps.num_resident() - num_parked_; }
  // Lets the warp leave, as soon as it can, if the policy wants it to.
  bool ask(uint32_t slot, Cycle now);
  void leave(Cycle now);

  const CoreParts core_;
  const MemoryAccesses& memory_;
  const uint32_t places_;
  const std::unique_ptr<Parking> policy_;
  ParkingStats stats_;
  std::vector<Slot> slots_;
  std::vector<uint32_t> waiting_;  // slots, in the order of their rays
  std::vector<uint32_t> leaving_;  // slots, in the order of their rays
  mem::Ring<uint32_t> returning_;  // slots, in the order in which their rays came back
  uint32_t num_parked_ = 0;
  bool has_blocks_ = true;
};

}  // namespace glint::core
