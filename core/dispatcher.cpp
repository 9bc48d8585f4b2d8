// Hands the blocks of a launch to the cores.
// SPDX-License-Identifier: Apache-2.0
#include "core/dispatcher.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::core {

Dispatcher::Dispatcher(const Params& params, uint32_t num_blocks, std::vector<CoreCell*> cores,
                       bool in_clusters, std::span<const uint32_t> chosen)
    : launch_latency_(params.launch_latency),
      warp_launch_latency_(params.warp_launch_latency),
      interval_parts_(Cycle(std::lround(
          (in_clusters && params.cluster_interval > 0 ? params.cluster_interval : params.grid_interval) *
          double(kParts)))),
      chosen_(chosen),
      num_blocks_(chosen.empty() ? num_blocks : uint32_t(chosen.size())),
      cores_(std::move(cores)) {
}

Cycle Dispatcher::take_start(Cycle ready) {
  const Cycle start = std::max(ready * kParts, free_parts_);
  free_parts_ = start + interval_parts_;
  return start / kParts;
}

void Dispatcher::dispatch(Cycle now) {
  const Cycle ready = std::max(now, launch_latency_) + warp_launch_latency_;
  for (bool any = true; any && !done();) {
    any = false;
    for (CoreCell* core : cores_) {
      if (done() || !core->has_room()) continue;
      core->launch(now, chosen_.empty() ? next_ : chosen_[next_], take_start(ready));
      ++next_;
      any = true;
      if (done())
        for (CoreCell* each : cores_) each->end_of_blocks();
    }
  }
}

}  // namespace glint::core
