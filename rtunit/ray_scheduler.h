// Declares the interface of the policies that choose which warp and lane of the RT unit sends a node request.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "base/stats.h"
#include "base/types.h"
#include "rtunit/traversal/ray_path.h"
#include "rtunit/treelets.h"

namespace glint::rt {

// Holds what a policy may know of a warp in the unit. The slots of the warp buffer follow each other in the
// span.
struct WarpView {
  bool ready = false;  // Some lane wants a node.
  uint32_t lanes_wanting = 0;
  uint64_t age = 0;  // order of arrival: the older warp has the smaller number
  Cycle arrived = 0;
};

// Shows the nodes that lanes want, to a policy that chooses by them.
class WantedNodes {
 public:
  virtual ~WantedNodes() = default;
  // Returns the lanes of a warp, by its index in the span of views, that want a node.
  virtual LaneMask lanes(uint32_t warp) const = 0;
  // Returns the node that such a lane wants. Two lanes want the same node when these are equal.
  virtual const Fetch& node(uint32_t warp, int lane) const = 0;
  // Returns the treelet of that node.
  virtual TreeletId treelet(uint32_t /*warp*/, int /*lane*/) const { return kNoTreelet; }
  // Returns the treelet that the prefetcher reads ahead, if it goes by treelets.
  virtual TreeletId treelet_ahead() const { return kNoTreelet; }
};

// Contract (tests/contract/rt_ray_scheduler_test.cpp):
//  - pick() returns the index of a ready warp, or kNone only when none is ready.
//  - A policy that chooses by nodes overrides choose() instead, which has the same duties; its lane is one
//    that wants a node.
//  - The choice depends on the arguments and the policy's own state only.
//  - No ready warp is skipped for ever while no older warp is ready: it is chosen at last when the others
//    leave.
class RayScheduler {
 public:
  static constexpr PolicyKind kKind{"rt.scheduler", "rtunit/schedulers"};
  static constexpr uint32_t kNone = ~0u;
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
    uint32_t warps = 0;             // slots of the warp buffer
  };
  // Names a warp and one of its lanes. Lane -1 stands for the lowest lane that wants a node.
  struct Choice {
    uint32_t warp = kNone;
    int lane = -1;
  };
  virtual ~RayScheduler() = default;
  // Returns whether the scheduler goes by the treelet that a prefetcher reads ahead.
  virtual bool needs_treelet_ahead() const { return false; }
  virtual uint32_t pick(std::span<const WarpView> /*warps*/) { return kNone; }
  virtual Choice choose(std::span<const WarpView> warps, const WantedNodes&) { return {pick(warps), -1}; }
};

}  // namespace glint::rt
