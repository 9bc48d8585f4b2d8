// Says which blocks of a launch a timing machine runs when it does not run all of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "base/types.h"

namespace glint::pipeline {

class LaunchPart {
 public:
  virtual ~LaunchPart() = default;
  // Returns the blocks that run, in the order in which they start. There is at least one.
  virtual std::span<const uint32_t> blocks() const = 0;
  // Is called at the start of each turn, when `started` of the blocks have started and others may start next.
  // All units stand still meanwhile.
  virtual void before_start(Cycle now, uint32_t started) = 0;
};

}  // namespace glint::pipeline
