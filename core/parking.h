// Declares the interface of the policies by which warps give up their places in a core while their rays are
// in the RT unit.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "base/params.h"
#include "base/registry.h"
#include "base/stats.h"
#include "base/types.h"

namespace glint::core {

// Holds how many warps may be without a place and what a return costs, whatever the policy. The default
// number makes, with 32 places, the 4,096 rays of Chou and Aamodt, ASPLOS 2025 (doi 10.1145/3676641.3716279).
// Choice: no source gives the time of a return; a line of stack pointers comes from their L2 in 187 cycles.
struct ParkingLotParams {
  uint32_t warps = 96, latency = 190;
  static ParamList params() {
    return {param(&ParkingLotParams::warps, "warps", "warp",
                  "Number of warps that a core can have beyond those that can run.", 1, 192),
            param(&ParkingLotParams::latency, "latency", "cycle",
                  "Cycles from the moment at which a warp has a place again to its next instruction.", 0,
                  100'000)};
  }
};

// Contract (tests/contract/parking_test.cpp):
//  - is_used() never changes. Without it no warp gives up a place, and a core has no slots beyond its places.
//  - gives_up() is asked when the RT unit has taken a warp's rays. When a warp wants to return and no place
//    is free, it is asked once more, for the warp with a place whose rays began last. It is a function of the
//    views so far and of the policy's own state: the same views give the same answers.
//  - A warp that gives up its place leaves when its accesses have been answered, unless its rays are back by
//    then. It returns when its rays are back and a place is free. Warps return in the order of their rays,
//    before new blocks begin.
//  - A policy changes cycles, and no result.
class Parking {
 public:
  static constexpr PolicyKind kKind{"core.parking", "core/parkings"};
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
  };
  // Says what a core holds when a warp waits for its rays.
  struct View {
    Cycle now = 0;
    uint32_t lanes = 0;       // rays of the warp that travel
    uint32_t places = 0;      // warps that can run at a time, as registers allow
    uint32_t held = 0;        // places that warps hold, with that of the warp
    uint32_t parked = 0;      // warps without a place
    uint32_t returning = 0;   // of these, warps whose rays are back
    bool has_blocks = false;  // Blocks of the launch have not begun on any core.
  };
  virtual ~Parking() = default;
  virtual bool is_used() const { return true; }
  virtual bool gives_up(const View&) = 0;
};

}  // namespace glint::core
