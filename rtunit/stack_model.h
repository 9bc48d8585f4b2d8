// Declares the interface of the policies that choose where the entries of a ray's stack are kept.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/registry.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::rt {

inline constexpr int kEntriesPerSector = 4;  // 32 B of StackEntry
static_assert(kEntriesPerSector * sizeof(StackEntry) == 32);

// Says what the RT unit has to do before the ray's next node. Row r of a stack off chip holds its entries 4r
// .. 4r + 3. With a shared area, rows leave the chip for that area, and each row that spills comes from
// there.
struct StackWork {
  uint16_t row = 0;  // The stack in memory ended here: spills go to this row and up, fills come from below.
  uint16_t spills = 0;  // sectors to write
  uint16_t fills = 0;   // sectors to read, one after the other
  uint16_t shared_row =
      0;                // The stack off chip ended here: stores go to this row and up, loads come from below.
  uint16_t stores = 0;  // rows that go to the shared area, the last `spills` of them after a spill each
  uint16_t loads = 0;   // rows that come from the shared area, one after the other, before all fills
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

// Says how much of an SM's shared memory holds entries of rays' stacks, and how the RT unit comes to them.
// Four rows go through a port at once when they lie in different quarters of the banks.
struct SharedArea {
  uint32_t rows = 0;           // rows per ray, of 32 B; 0: there is no such area
  uint32_t ports = 1;          // passes in a cycle
  Cycle latency = 0;           // cycles from the pass that reads a row to the ray's next node
  bool is_interleaved = true;  // Rows of one number lie together, lane by lane, and not those of one ray.
  uint32_t bytes_per_warp() const { return rows * uint32_t(kLanes) * 32; }
  // Returns which quarter of the banks holds a row of the lane's ray.
  uint32_t quarter(uint32_t row, int lane) const {
    return (is_interleaved ? uint32_t(lane) : uint32_t(lane) * rows + row % rows) % kQuarters;
  }
  static constexpr uint32_t kQuarters = 4;  // 32 banks of 4 B, and rows of 32 B
};

// Contract (tests/contract/rt_stack_model_test.cpp):
//  - settle() is called when the ray enters the unit and after each of its visits. It changes nothing but
//    `stack_off_chip` and `stack_in_memory`.
//  - Afterwards the ray's next entry is on chip, and the chip holds no more entries than the model has room
//    for.
//  - Every sector that is filled was spilled before, and is not filled again before it is spilled again. The
//    same holds for loads and stores of the shared area, which never holds more rows than it has room for.
//  - A model has no state of its own and serves all rays.
class StackModel {
 public:
  static constexpr PolicyKind kKind{"rt.stack", "rtunit/stacks"};
  struct Context {};
  virtual ~StackModel() = default;
  virtual uint32_t rows() const { return 0; }        // rows of the StackLayout
  virtual bool keeps_path() const { return false; }  // whether rays need a RayPath
  virtual SharedArea shared_area() const { return {}; }
  virtual StackWork settle(RayState& state) const = 0;
};

}  // namespace glint::rt
