// Says what a caller hears of a launch while it runs, and what ends a launch early.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "base/types.h"

namespace glint::pipeline {

// Says how far a launch has come.
struct LaunchProgress {
  uint64_t ended_warps = 0, num_warps = 0;
  Cycle cycles = 0;           // 0 on the functional machine
  uint64_t instructions = 0;  // warp instructions
  std::string where{};        // of a launch that was ended early: exec::BusiestLine::to_string()
};

// Says why a launch ended.
enum class LaunchEnd : uint8_t {
  Whole,      // All warps have ended.
  MaxCycles,  // LaunchWatch::max_cycles was reached.
  Stopped     // LaunchWatch::stop said so.
};

// Watches a launch. Both machines look at it only between turns, or between quanta of instructions, so it
// costs the loop over cycles nothing.
struct LaunchWatch {
  // Is called now and then. `line` returns the source line where most running warps are, such as
  // "path.rgen:12"; that takes longer than everything else here, and the text is empty without warps.
  std::function<void(const LaunchProgress&, const std::function<std::string()>& line)> progress{};
  // Is asked between turns or quanta. Answering true ends the launch early: it keeps what its warps have done
  // up to then, and the statistics say so.
  std::function<bool()> stop{};
  // The launch ends at the first turn that begins at this cycle or later, for the same cycle at any number of
  // threads. 0 stands for no limit. Only the timing machine has cycles.
  Cycle max_cycles = 0;
  // The program is known to come to an end, so core.turnover_budget does not apply.
  bool is_bounded = false;
};

}  // namespace glint::pipeline
