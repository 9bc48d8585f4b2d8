// Keeps rays in the warps in which the core gave them, and tells when a warp has become thin.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "base/num_lanes.h"
#include "memsys/ring.h"
#include "rtunit/ray_pool.h"

namespace glint::rt {

// Holds the ids of rays that have been in no warp of the unit.
class GivenWarps {
 public:
  bool empty() const { return ids_.empty(); }
  void push(uint32_t id) { ids_.push(id); }
  // Takes the rays of the warp that the core gave first, writes their ids, and returns their number.
  uint32_t take(std::span<uint32_t, kLanes> ids) {
    uint32_t count = 0;
    while (!ids_.empty() && (count == 0 || ids_.front() / kLanes == ids[0] / kLanes)) {
      ids[count++] = ids_.front();
      ids_.pop();
    }
    return count;
  }

 private:
  mem::Ring<uint32_t> ids_;  // warp after warp
};

// Returns whether fewer than `least` rays of a warp run and there are enough others to fill one.
inline bool is_thin(const FormedWarp& warp, uint32_t least) {
  const uint32_t running = num_lanes(warp.running);
  return running < least && running + warp.waiting >= uint32_t(kLanes);
}

}  // namespace glint::rt
