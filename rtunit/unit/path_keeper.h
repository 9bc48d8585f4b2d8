// Gives rays the paths that stack models and entries ask for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

// Model: a ray loses its path when it waits for a shader and a second ray of its lane overtakes it (a ray
// query in an any-hit shader).
class PathKeeper final : public WalkHook {
 public:
  explicit PathKeeper(WarpBuffer& buffer) : buffer_(buffer) {}

  void entered(uint32_t slot, int lane, Cycle now) override;
  void moved(uint32_t /*slot*/, int /*lane*/, Cycle /*now*/) override {}  // move_ray() has told the path.

 private:
  using WarpPaths = std::array<RayPath, kLanes>;

  WarpBuffer& buffer_;
  std::vector<std::unique_ptr<WarpPaths>> paths_;  // by the core's warp slot
};

// Moves a ray with its path, in exchange for what was there.
inline void move_ray(RayState& from, RayState& to) {
  if (from.path && from.path->ray == &from) from.path->ray = &to;
  std::swap(from, to);
}

}  // namespace glint::rt
