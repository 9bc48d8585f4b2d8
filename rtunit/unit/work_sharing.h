// Lets lanes of a warp visit nodes for the rays of other lanes, as a work mapping decides.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "memsys/address_space.h"
#include "rtunit/params.h"
#include "rtunit/unit/ray_walk.h"
#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

struct WorkSharingStats {
  explicit WorkSharingStats(stats::Group* parent) : group(parent, "mapping") {}
  stats::Group group;
  stats::Counter moves{&group, "moves", "entry", "Number of stack entries that changed their lane."};
  stats::Counter stale_moves{&group, "stale_moves", "entry",
                             "Number of these that lay behind the ray's hit and were dropped."};
  stats::Counter helped_nodes{&group, "helped_nodes", "node",
                              "Number of nodes that a lane visited for another lane's ray."};
  stats::Counter helper_cycles{
      &group, "helper_cycles", "lane*cycle",
      "Cycles from a lane's taking of another's entry to the end of that work, summed over lanes."};
  stats::Counter helper_hits{&group, "helper_hits", "hit",
                             "Number of times that a lane found a nearer hit for another lane's ray."};
};

// A lane that takes an entry owns a part of the ray: a state with that entry on a stack of its own. The ray
// has one nearest hit, which all its lanes share. A ray whose own stack is empty waits for its parts, and its
// lane may take work meanwhile.
// Model: a move and a merge of hits take no time of their own; the new node is asked for in the cycle of the
// move. Model: rays that may need a shader are not shared. Model: the lanes of a ray that ends at its first
// hit finish the node that they are at.
class WorkSharing final : public WalkHook {
 public:
  WorkSharing(const Params& params, const mem::AddressSpace& memory, WarpBuffer& buffer, RayWalk& walk,
              RtStats& stats);

  void entered(uint32_t slot, int lane, Cycle now) override;
  bool detour(uint32_t slot, int lane, Cycle now) override;
  void visited(const Visit& visit) override;

  // Makes the moves of a cycle. The warp that has been in the unit longest comes first.
  void share(Cycle now);
  Cycle next_event(Cycle now) const { return first_to_share(~uint64_t{0}) == kNone ? kNever : now + 1; }

 private:
  static constexpr uint32_t kNone = ~0u;
  struct Lanes {
    LaneMask shareable = 0;  // lanes whose own ray may be shared
    LaneMask waiting = 0;    // lanes whose own ray waits for its parts
    LaneMask ended = 0;      // lanes whose own ray has found the hit that ends it
    LaneMask givers = 0;
    std::array<uint8_t, kLanes> helpers{};  // number of lanes that work for the lane's ray
    std::array<Cycle, kLanes> since{};      // when the lane began to help
    std::vector<RayState> parts;            // by lane
  };
  LaneMask takers(uint32_t slot) const;
  uint32_t first_to_share(uint64_t slots) const;
  void update_giver(uint32_t slot, int lane);
  void make(uint32_t slot, const WorkMove& move, Cycle now);
  void end_part(uint32_t slot, int lane, Cycle now);

  const std::unique_ptr<WorkMapping> policy_;
  const uint32_t moves_per_cycle_;
  const mem::AddressSpace& memory_;
  WarpBuffer& buffer_;
  RayWalk& walk_;
  WorkSharingStats stats_;
  std::vector<Lanes> lanes_;  // by slot
  uint64_t with_givers_ = 0;  // bit i: slot i has givers
};

}  // namespace glint::rt
