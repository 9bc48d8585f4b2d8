// Models how a core suspends warps that wait for a phase of a barrier in shared memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/core_parts.h"

namespace glint::core {

// A warp whose mbarrier.try_wait finds that a phase has not ended is suspended: it issues nothing until an
// arrival ends the phase, or for core.async.suspension cycles. PTX leaves the time to the machine. Model:
// suspendTimeHint does not change it; on an H200 hints from 0 to 0.1 s gave the same time. A warp that is
// suspended asks again without the load-store unit.
class MbarrierUnit {
 public:
  // Returns null when the program has no mbarrier.*.
  static std::unique_ptr<MbarrierUnit> make(const CoreParts& core);
  explicit MbarrierUnit(const CoreParts& core);

  // Notes that the warp has executed an mbarrier.*. Returns true when the warp is suspended.
  bool come(uint32_t slot, const exec::Issued& issued, Cycle now);
  // Lets warps of the block go on whose phases have ended.
  void look(const exec::Block& block, Cycle now);
  // Lets warps go on that have waited for long enough.
  void tick(Cycle now) {
    if (next_event() <= now) end_first(now);
  }
  // Returns the earliest cycle with work for tick(), or kNever.
  Cycle next_event() const {
    return waiting_.empty() ? kNever : waiting_.front().since + core_.params.async.suspension;
  }

 private:
  struct Waiting {
    uint32_t slot, pc;
    LaneMask lanes;
    Cycle since;
    uint64_t phases;  // Block::ended_phases when it asked last
  };
  void end_first(Cycle now);
  void let_go(const Waiting& waiting, Cycle at, Cycle now);

  const CoreParts core_;
  std::vector<Waiting> waiting_;  // in the order in which they came
};

}  // namespace glint::core
