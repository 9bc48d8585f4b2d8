// Multiplies the sizes of a launch without overflow.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/launch_size.h"

#include <fmt/format.h>

namespace glint::pipeline {

void check_launch_size(const std::array<uint32_t, 3>& grid, const std::array<uint32_t, 3>& block,
                       const SourceLocation& where) {
  uint64_t threads = uint64_t{block[0]} * block[1] * block[2];  // at most 1,024
  for (const uint32_t size : grid) {
    if (threads != 0 && size > kMostThreads / threads)
      throw UserError(
          where,
          fmt::format("a launch of {} x {} x {} blocks of {} threads has more than {} threads", grid[0],
                      grid[1], grid[2], uint64_t{block[0]} * block[1] * block[2], kMostThreads));
    threads *= size;
  }
}

}  // namespace glint::pipeline
