// Leads a ray through the RT unit: decides where it starts, which node is next, what a visit does and when it
// stops.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/probe.h"
#include "memsys/address_space.h"
#include "rtunit/params.h"
#include "rtunit/unit/rt_stats.h"
#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

// Tells of a lane's visit of a node when its test starts.
struct NodeVisited {
  Cycle cycle = 0;
  uint32_t warp_slot = 0;
  int lane = 0;
  Fetch node;
};

class RayWalk {
 public:
  RayWalk(const Params& params, const mem::AddressSpace& memory, WarpBuffer& buffer, RtStats& stats);
  void add(WalkHook& hook) { hooks_.push_back(&hook); }

  // Begins the walk of a ray that enters the unit, for the first time or again after a shader. `waited`:
  // cycles that it was in the unit before it got its lane.
  void start(uint32_t slot, int lane, Cycle now, Cycle waited = 0);
  // Continues with a lane that is between two nodes. The lane wants the next node or stops, unless a hook has
  // something to do first.
  void go_on(uint32_t slot, int lane, Cycle now);
  // Starts the test of a node. The functional step is made now; the unit sees its outcome when the test ends.
  void start_test(uint32_t slot, int lane, Cycle now);
  void end_test(uint32_t slot, int lane, Cycle now);
  // These bring what a test that starts soon needs near to the host's core: the lane's ray, and the node.
  void prefetch_ray(uint32_t slot, int lane) const { prefetch(buffer_[slot].ray_of(lane)); }
  void prefetch_node(const Fetch& node) const {
    const std::byte* const bytes = memory_.find(node.address, node.bytes);
    if (!bytes) return;
    __builtin_prefetch(bytes);
    __builtin_prefetch(bytes + node.bytes - 1);
  }
  // Lets a lane begin to work on a part of another lane's ray, which WorkSharing has given it.
  void start_part(uint32_t slot, int lane, Cycle now);
  // Continues with a ray that a ray pool has put into this lane.
  void start_elsewhere(uint32_t slot, int lane, Cycle now);
  // Ends the walk of the lane's own ray.
  void stop(uint32_t slot, int lane, Cycle now);

  Probe<NodeVisited>& node_visited() { return node_visited_; }

 private:
  void visit(uint32_t slot, int lane, Cycle now);

  const bool retest_;
  const mem::AddressSpace& memory_;
  WarpBuffer& buffer_;
  RtStats& stats_;
  const std::array<stats::Counter*, 5> nodes_of_kind_;  // statistics, by NodeKind
  const std::unique_ptr<ChildOrder> child_order_;
  std::vector<WalkHook*> hooks_;
  Probe<NodeVisited> node_visited_;
};

}  // namespace glint::rt
