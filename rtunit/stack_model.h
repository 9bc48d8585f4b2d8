// Declares the interface of the policies that choose where the entries of a ray's stack are kept.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/registry.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::rt {

inline constexpr int kEntriesPerSector = 4;  // 32 B of StackEntry
static_assert(kEntriesPerSector * sizeof(StackEntry) == 32);

// Says what the RT unit has to do before the ray's next node. Row r of a stack in memory holds its entries 4r
// .. 4r + 3.
struct StackWork {
  uint16_t row = 0;  // The stack in memory ended here: spills go to this row and up, fills come from below.
  uint16_t spills = 0;    // sectors to write
  uint16_t fills = 0;     // sectors to read, one after the other
  uint16_t replays = 0;   // nodes to visit again: RayPath::node from the root on
  uint16_t replayed = 0;  // number of these nodes that the lane has asked for
};

// Says where stacks lie in memory. The layout is that of candidate tables
// (rtunit/traversal/candidate_table.h), so that lanes share lines.
struct StackLayout {
  Address base = 0;   // physical, of this core
  uint32_t rows = 0;  // sectors per ray; 0: stacks never leave the chip
  uint64_t bytes_per_warp() const { return uint64_t{rows} * kLanes * 32; }
  Address sector(uint32_t warp_slot, uint32_t row, int lane) const {
    return base + ((uint64_t{warp_slot} * rows + row) * kLanes + uint64_t(lane)) * 32;
  }
};

// Contract (tests/contract/rt_stack_model_test.cpp):
//  - settle() is called when the ray enters the unit and after each of its visits. It changes nothing but
//    `stack_off_chip`.
//  - Afterwards the ray's next entry is on chip, and the chip holds no more entries than the model has room
//    for.
//  - Every sector that is filled was spilled before, and is not filled again before it is spilled again.
//  - A model has no state of its own and serves all rays.
class StackModel {
 public:
  static constexpr PolicyKind kKind{"rt.stack", "rtunit/stacks"};
  struct Context {};
  virtual ~StackModel() = default;
  virtual uint32_t rows() const { return 0; }        // rows of the StackLayout
  virtual bool keeps_path() const { return false; }  // whether rays need a RayPath
  virtual StackWork settle(RayState& state) const = 0;
};

}  // namespace glint::rt
