// What a core counts of its instruction and constant caches.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "base/stats.h"

namespace glint::core {

struct CodeStats : stats::Group {
  explicit CodeStats(Group* parent) : Group(parent, "code") {}

  stats::Counter lines{this, "lines", "line", "Instruction lines that warps came to."};
  stats::Counter misses{this, "misses", "line",
                        "Of them, those that had to wait: neither in the L0 nor in the stream buffer."};
  stats::Counter prefetch_hits{this, "prefetch_hits", "line", "Of them, those that the stream buffer had."};
  stats::Counter prefetches{this, "prefetches", "line", "Lines that stream buffers asked for."};
  stats::Counter constant_lines{this, "constant_lines", "line", "Lines that constant loads looked up."};
  stats::Counter constant_misses{this, "constant_misses", "line", "Of them, those that were not there."};
  stats::Counter cache_reads{this, "cache_reads", "line", "Lines asked of the cache behind both."};
  stats::Counter cache_misses{this, "cache_misses", "line", "Of them, those that had to come from the L2."};
};

}  // namespace glint::core
