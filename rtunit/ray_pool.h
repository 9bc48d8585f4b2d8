// Declares the interface of the policies that form the warps of the RT unit from the rays of several warps.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "base/registry.h"
#include "base/stats.h"
#include "base/types.h"
#include "memsys/address_space.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::rt {

// Describes a ray that waits in the pool.
struct WaitingRay {
  uint32_t id = 0;            // Rays of the same warp of the core have the same id / kLanes.
  bool is_new = false;        // It has been in no warp of the unit since the core gave it.
  bool is_predicted = false;  // takes_predicted() took it back before its first visit.
  const RayState* ray = nullptr;
};

// Describes a warp of the unit, one of whose rays is between two nodes.
struct FormedWarp {
  uint32_t slot = 0;               // of the warp buffer
  LaneMask running = 0;            // lanes whose ray has neither stopped nor gone back
  uint32_t waiting = 0;            // rays in the pool
  std::span<const RayState> rays;  // by lane; those of `running` are valid
};

// Contract (tests/contract/rt_ray_pool_test.cpp):
//  - A ray that add() was given is in the pool until form() names it. form() names each at most once.
//  - form() is asked when the warp buffer has room and rays wait. It names no ray only when another ray will
//    come, or at the cycle of next_event() a warp will be formed without one. While the unit holds no warp it
//    names at least one, or next_event() has a cycle.
//  - goes_back() is asked after each visit of a ray that goes on, and takes_predicted() once for a ray whose
//    look-up has given a node (rt.entry), before its first visit. A ray goes back only when a later form()
//    names it without a visit of another ray, if the unit holds nothing else.
//  - The choice depends on the arguments and the policy's own state only.
//  - A pool changes cycles, never hits.
class RayPool {
 public:
  static constexpr PolicyKind kKind{"rt.pool", "rtunit/pools"};
  static constexpr std::string_view kNone = "none";  // Under this name warps stay as the core gave them.
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
    const mem::AddressSpace& memory;
    uint32_t slots = 0;  // slots of the warp buffer
    uint32_t rays = 0;   // Every id is below this number.
  };
  virtual ~RayPool() = default;
  // Returns whether the policy asks for the treelets of nodes, so that structures must have them.
  virtual bool needs_treelets() const { return false; }
  virtual void add(const WaitingRay&, Cycle /*now*/) {}
  // Writes the ids of the rays of the next warp to `ids` and returns their number. They take the lanes from 0
  // on, in this order.
  virtual uint32_t form(std::span<uint32_t, kLanes> /*ids*/, Cycle /*now*/) { return 0; }
  // Tells the slot of the warp that form() has named last.
  virtual void formed(uint32_t /*slot*/) {}
  // Returns whether the ray in `lane` goes back to the pool.
  virtual bool goes_back(const FormedWarp&, int /*lane*/) { return false; }
  // Returns whether the ray in `lane`, which has been in no other warp, goes back to be with others that know
  // where to begin.
  virtual bool takes_predicted(const FormedWarp&, int /*lane*/) { return false; }
  // Returns the cycle at which form() will name rays though nothing has changed, or kNever.
  virtual Cycle next_event(Cycle /*now*/) const { return kNever; }
};

}  // namespace glint::rt
