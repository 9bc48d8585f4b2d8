// Models a core's barrier unit: warps come to it one after another, and it lets the warps of a block go on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "core/core_parts.h"

namespace glint::core {

// Says when warps go on. Which barriers are open is the block's state (exec/block.h).
class BarrierUnit {
 public:
  explicit BarrierUnit(const CoreParts& core) : core_(core) {}
  // Notes that the warp has executed a bar.*. The warp goes on `latency` cycles after its turn at the unit,
  // or when its barrier opens.
  void come(uint32_t slot, Cycle now, Cycle latency);
  // Notes that a warp of the block has ended, which may have opened a barrier for the others.
  void end_warp(const exec::Block& block, Cycle now);

 private:
  void pass(const exec::Block& block, Cycle at, Cycle now);

  const CoreParts core_;
  Cycle free_at_ = 0;  // first cycle in which the unit takes another warp
};

}  // namespace glint::core
