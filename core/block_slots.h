// Holds the slots that a core has for blocks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/check.h"
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
  // Notes that one warp of the block has left its warp slot.
  void leave(BlockSlot& slot) {
    if (--slot.warps == 0) --num_taken_;
  }

 private:
  std::vector<BlockSlot> slots_;
  uint32_t num_taken_ = 0;
};

}  // namespace glint::core
