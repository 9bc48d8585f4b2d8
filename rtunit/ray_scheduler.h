// Declares the interface of the policies that choose which warp of the RT unit sends a node request.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "base/stats.h"
#include "base/types.h"

namespace glint::rt {

// Holds what a policy may know of a warp in the unit. The slots of the warp buffer follow each other in the
// span.
struct WarpView {
  bool ready = false;  // Some lane wants a node.
  uint32_t lanes_wanting = 0;
  uint64_t age = 0;  // order of arrival: the older warp has the smaller number
  Cycle arrived = 0;
};

// Contract (tests/contract/rt_ray_scheduler_test.cpp):
//  - pick() returns the index of a ready warp, or kNone only when none is ready.
//  - The choice depends on the arguments and the policy's own state only.
//  - No ready warp is skipped for ever while no older warp is ready: it is chosen at last when the others
//    leave.
class RayScheduler {
 public:
  static constexpr PolicyKind kKind{"rt.scheduler", "rtunit/schedulers"};
  static constexpr uint32_t kNone = ~0u;
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
  };
  virtual ~RayScheduler() = default;
  virtual uint32_t pick(std::span<const WarpView> warps) = 0;
};

}  // namespace glint::rt
