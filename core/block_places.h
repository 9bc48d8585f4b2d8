// Holds the places that a core has for blocks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/check.h"
#include "exec/block.h"

namespace glint::core {

// Holds a block until all accesses of all its warps have ended.
struct BlockPlace {
  exec::Block block;
  uint32_t warps = 0;  // warps of the block that still hold a slot; 0: the place is free
};

// Holds all places. They keep their addresses, because warps point to their block.
class BlockPlaces {
 public:
  explicit BlockPlaces(uint32_t count) : places_(count) {}
  uint32_t size() const { return uint32_t(places_.size()); }
  uint32_t num_taken() const { return num_taken_; }
  // Returns the first free place, for a block of `warps` warps.
  BlockPlace& take(uint32_t warps) {
    const auto free = std::find_if(places_.begin(), places_.end(),
                                   [](const BlockPlace& place) { return place.warps == 0; });
    GLINT_CHECK(free != places_.end(), "no place for a block");
    free->warps = warps;
    ++num_taken_;
    return *free;
  }
  // Notes that one warp of the block has left its slot.
  void leave(BlockPlace& place) {
    if (--place.warps == 0) --num_taken_;
  }

 private:
  std::vector<BlockPlace> places_;
  uint32_t num_taken_ = 0;
};

}  // namespace glint::core
