// The barrier unit of a core: warps come to it one after another, and it lets the warps of a block go on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "core/core_parts.h"

namespace glint::core {

// Which barriers are open is the block's state (exec/block.h); the unit says when their warps go on.
class BarrierUnit {
 public:
  explicit BarrierUnit(const CoreParts& core) : core_(core) {}
  // The warp has executed a bar.*. It goes on `latency` cycles after its turn at the unit, or when its
  // barrier opens.
  void come(uint32_t slot, Cycle now, Cycle latency);
  // A warp of the block has ended, which may have opened a barrier for the others.
  void end_warp(const exec::Block& block, Cycle now);

 private:
  void pass(const exec::Block& block, Cycle at, Cycle now);

  const CoreParts core_;
  Cycle free_at_ = 0;  // The first cycle in which the unit takes another warp.
};

}  // namespace glint::core
