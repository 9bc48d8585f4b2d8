// Counts what regrouping threads did to a core's warps, and what it cost.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "base/stats.h"

namespace glint::core {

struct ReorderStats : stats::Group {
  explicit ReorderStats(Group* parent) : Group(parent, "reorder") {}

  stats::Counter warps{this, "warps", "warp", "Number of times that a warp came to be regrouped."};
  stats::Counter threads{this, "threads", "lane",
                         "Number of running threads in warps that came to be regrouped."};
  stats::Counter batches{this, "batches", "batch", "Number of times that waiting warps were regrouped."};
  stats::Counter timeouts{this, "timeouts", "batch",
                          "Number of batches that went because their time was over."};
  stats::Counter threads_moved{this, "threads_moved", "lane",
                               "Number of threads that went to another warp, whether they ran or waited."};
  stats::Ratio moved_share{this,       "moved_share",
                           "fraction", threads_moved,
                           threads,    "Threads that went to another warp, for each that came."};
  stats::Counter bytes_moved{this, "bytes_moved", "byte",
                             "Bytes of registers and stack that went to another warp."};
  stats::Counter warps_ended{this, "warps_ended", "warp",
                             "Number of warps that ended because all of their threads had left them."};
  stats::Counter warps_before{this, "warps_before", "warp",
                              "Number of warps with running threads before regrouping."};
  stats::Counter warps_after{this, "warps_after", "warp",
                             "Number of warps with running threads after regrouping."};
  stats::Counter keys_before{this, "keys_before", "key",
                             "Number of different keys in each warp before regrouping, summed over warps."};
  stats::Counter keys_after{this, "keys_after", "key",
                            "Number of different keys in each warp after regrouping, summed over warps."};
  stats::Ratio keys_per_warp_before{
      this,        "keys_per_warp_before", "key/warp",
      keys_before, warps_before,           "Mean number of different keys in a warp before regrouping."};
  stats::Ratio keys_per_warp_after{this,        "keys_per_warp_after",
                                   "key/warp",  keys_after,
                                   warps_after, "Mean number of different keys in a warp after regrouping."};
  stats::Counter wait_cycles{this, "wait_cycles", "warp-cycle",
                             "Cycles that warps waited for the others of their batch, summed over warps."};
  stats::Counter move_cycles{this, "move_cycles", "warp-cycle",
                             "Cycles from regrouping to the next instruction, summed over warps."};
};

}  // namespace glint::core
