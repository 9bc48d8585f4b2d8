// Gives rays the paths that stack models and entries ask for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
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

 private:
  using WarpPaths = std::array<RayPath, kLanes>;

  WarpBuffer& buffer_;
  std::vector<std::unique_ptr<WarpPaths>> paths_;  // by the core's warp slot
};

}  // namespace glint::rt
