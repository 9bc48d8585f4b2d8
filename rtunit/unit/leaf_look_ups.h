// Asks the leaf filter for the rays of an RT unit, and reads what its answers need.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "rtunit/leaf_filter.h"
#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

// Stands between the rays and the filter. A ray that has got answers from memory reads those bytes before it
// goes on, stops or goes to a shader. Model: a lane reads for one candidate at a time, and what it does with
// a state that has come takes no time.
class LeafLookUps final : public WalkHook, private LeafFilter {
 public:
  LeafLookUps(std::unique_ptr<LeafFilter> filter, WarpBuffer& buffer);

  void entered(uint32_t slot, int lane, Cycle now) override;
  bool detour(uint32_t slot, int lane, Cycle now) override;
  void visited(const Visit& visit) override;

 private:
  // Holds the addresses that a lane has still to read, at most one for each triangle of a leaf.
  struct Reads {
    std::array<Address, 2> from{};
    uint32_t count = 0;
  };

  LeafAnswer look_up(const LeafQuestion& question) const override;

  const std::unique_ptr<LeafFilter> filter_;
  WarpBuffer& buffer_;
  mutable std::array<LeafAnswer, 2> answers_;  // of the step that is being made
  mutable uint32_t num_answers_ = 0;
  std::vector<std::array<Reads, kLanes>> reads_;  // by slot
};

}  // namespace glint::rt
