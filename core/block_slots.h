// Holds the slots that a core has for blocks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/check.h"
#include "base/types.h"
#include "exec/block.h"

namespace glint::core {

// Holds a block until all accesses of all its warps have ended.
struct BlockSlot {
  exec::Block block;
  uint32_t warps = 0;  // warps of the block that still hold a warp slot; 0: the slot is free
};

// Holds all slots. They keep their addresses, because warps point to their block.
class BlockSlots {
 public:
  explicit BlockSlots(uint32_t count) : slots_(count) {}
  uint32_t size() const { return uint32_t(slots_.size()); }
  uint32_t num_taken() const { return num_taken_; }
  // Returns the first free slot, for a block of `warps` warps.
  BlockSlot& take(uint32_t warps) {
    const auto free =
        std::find_if(slots_.begin(), slots_.end(), [](const BlockSlot& slot) { return slot.warps == 0; });
    GLINT_CHECK(free != slots_.end(), "no slot for a block");
    free->warps = warps;
    ++num_taken_;
    return *free;
  }
  // Notes that one warp of the block leaves its warp slot in cycle `now`.
  void leave(BlockSlot& slot, Cycle now) {
    if (--slot.warps > 0) return;
    --num_taken_;
    last_end_ = now + 1;
  }
  // Returns the first cycle in which the slot that became free last was free.
  std::optional<Cycle> last_end() const { return last_end_; }

 private:
  std::vector<BlockSlot> slots_;
  uint32_t num_taken_ = 0;
  std::optional<Cycle> last_end_;
};

}  // namespace glint::core
