// Counts accesses of a core's instruction and constant caches.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "base/stats.h"

namespace glint::core {

struct CodeStats : stats::Group {
  explicit CodeStats(Group* parent) : Group(parent, "code") {}

  stats::Counter lines{this, "lines", "line", "Number of instruction lines that warps came to."};
  stats::Counter misses{this, "misses", "line",
                        "Number of instruction lines that were neither in the L0 nor in the stream buffer, "
                        "so that the warp had to wait."};
  stats::Counter prefetch_hits{this, "prefetch_hits", "line",
                               "Number of instruction lines that the stream buffer had."};
  stats::Counter prefetches{this, "prefetches", "line", "Number of lines that stream buffers asked for."};
  stats::Counter constant_lines{this, "constant_lines", "line",
                                "Number of lines that constant loads looked up."};
  stats::Counter constant_misses{this, "constant_misses", "line",
                                 "Number of lines of constant loads that missed in the constant cache."};
  stats::Counter cache_reads{
      this, "cache_reads", "line",
      "Number of lines asked of the cache behind the instruction and constant caches."};
  stats::Counter cache_misses{
      this, "cache_misses", "line",
      "Number of lines that the cache behind the instruction and constant caches had to fetch from the L2."};
};

}  // namespace glint::core
