// Begins the path of a new ray, and finds that of a ray that comes back.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/path_keeper.h"

#include "base/check.h"

namespace glint::rt {

void PathKeeper::entered(uint32_t slot, int lane, Cycle) {
  const auto [warp_slot, own_lane] = buffer_[slot].place_of(lane);
  RayState& ray = buffer_[slot].ray_of(lane);
  if (paths_.size() <= warp_slot) paths_.resize(warp_slot + 1);
  if (!paths_[warp_slot]) paths_[warp_slot] = std::make_unique<WarpPaths>();
  RayPath& path = (*paths_[warp_slot])[size_t(own_lane)];
  if (ray.nodes_visited == 0) {
    GLINT_DCHECK(ray.stack_size == 1, "a new ray has {} nodes to visit", ray.stack_size);
    path.ray = &ray;
    path.depth = path.parent[0] = RayPath::kNoParent;
    ray.path = &path;
  } else if (ray.path != &path || path.ray != &ray) {
    ray.path = nullptr;
  }
}

}  // namespace glint::rt
