// Models one direction of a port or a wire of the network: how long a message occupies it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "base/types.h"

namespace glint::mem {

// A message occupies the link for a whole number of cycles.
class Link {
 public:
  explicit Link(uint32_t bytes_per_cycle) : bytes_per_cycle_(bytes_per_cycle) {}

  Cycle cycles(uint32_t bytes) const { return (bytes + bytes_per_cycle_ - 1) / bytes_per_cycle_; }
  Cycle free_at() const { return free_at_; }

  // Sends a message, which starts at max(ready, free_at()); returns the cycle in which its tail has left.
  Cycle leave(Cycle ready, uint32_t bytes) { return free_at_ = std::max(ready, free_at_) + cycles(bytes); }

  // Returns the cycle in which the link has received all of a message whose tail arrives at `tail` after
  // `sent_cycles` on the link before. When both links are unloaded and equally wide, receiving overlaps
  // sending and takes no further cycle.
  Cycle received_at(Cycle tail, Cycle sent_cycles, uint32_t bytes) const {
    const Cycle head = tail - sent_cycles;
    return std::max(tail, std::max(head, free_at_) + cycles(bytes));
  }
  void occupy_until(Cycle cycle) { free_at_ = cycle; }

 private:
  uint32_t bytes_per_cycle_;
  Cycle free_at_ = 0;
};

}  // namespace glint::mem
