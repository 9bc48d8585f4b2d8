// Hands the blocks of a launch, or some of them, to the cores: in order, to whichever core has room.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"
#include "core/core_cell.h"
#include "core/params.h"

namespace glint::core {

// Acts only between windows. It gives one block to each core in turn, with the cores in their fixed order, so
// the assignment is a function of the model and not of how cells are run. Room that becomes free in a window
// is filled at the window's end. Model: hardware would fill it some cycles earlier or later; windows are
// shorter than a memory access, and `refill_latency` counts from the cycle that a block ends in. Blocks start
// in launch order, `grid_interval` apart, or `cluster_interval` with `in_clusters` (exec::World): one unit of
// the GPU starts them all.
class Dispatcher {
 public:
  // `chosen` are the blocks that run, in their order; when it is empty, all `num_blocks` run. What it refers
  // to outlives the dispatcher.
  Dispatcher(const Params& params, uint32_t num_blocks, std::vector<CoreCell*> cores, bool in_clusters,
             std::span<const uint32_t> chosen = {});
  // Fills the cores at `now`, the start of a window.
  void dispatch(Cycle now);
  bool done() const { return next_ == num_blocks_; }
  uint32_t num_dispatched() const { return next_; }  // number of blocks

 private:
  static constexpr Cycle kParts = 16;  // number of parts of a cycle
  // Returns when the next block starts that could start at `ready`.
  Cycle take_start(Cycle ready);

  const Cycle launch_latency_, warp_launch_latency_, interval_parts_;
  const std::span<const uint32_t> chosen_;
  const uint32_t num_blocks_;
  std::vector<CoreCell*> cores_;
  uint32_t next_ = 0;
  Cycle free_parts_ = 0;  // earliest start of the next block, in parts of a cycle
};

}  // namespace glint::core
