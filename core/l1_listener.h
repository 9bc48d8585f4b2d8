// Declares the interface that hears what the L1 of a core does for the warps of one scheduler.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "base/types.h"

namespace glint::core {

// Warps are those of the scheduler, by their local numbers. Lines are physical addresses. Model: the
// scheduler hears of an event in the cycle in which it happens.
//
// Contract:
//  - start() comes before the first cycle. It does not come when the core has an L1 that tells nothing.
//  - The events come in the order in which the L1 has them, which no thread and no window changes.
//  - A listener allocates nothing after start().
class L1Listener {
 public:
  virtual ~L1Listener() = default;
  // Tells how many lines the L1 holds: places have the numbers below that.
  virtual void start(uint32_t lines) = 0;
  // Tells that a read of the warp has missed, in a line of which no data are on the way for it yet.
  virtual void missed(uint32_t warp, Address line) = 0;
  // Tells that the place got a line, which `warp` has asked for: none when it was a warp of another
  // scheduler, or the RT unit. `victim` is the line that made way, if there was one.
  virtual void replaced(uint32_t place, std::optional<uint32_t> warp, std::optional<Address> victim) = 0;
};

}  // namespace glint::core
