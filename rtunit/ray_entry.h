// Declares the interface of the policies that choose where a ray begins its walk.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/registry.h"
#include "base/stats.h"
#include "memsys/address_space.h"
#include "rtunit/traversal/ray_state.h"
#include "rtunit/traversal/traversal.h"

namespace glint::rt {

// A ray whose look-up gives a node walks the subtree of that node first and then, unless a hit there has
// ended it, everything from the root. So a wrong choice costs cycles and changes no result.
//
// Model: only rays that can need no shader are looked up, because the primitives of a wrong subtree are
// tested twice.
//
// Contract (tests/contract/rt_ray_entry_test.cpp):
//  - No call changes a ray. A policy sees each of its rays in this order: wants(), look_up(), learn() for
//    each hit that was not predicted, ended(). With a ray pool (rt.pool) it may lie elsewhere at each call.
//  - What it answers depends on the calls alone, and not on how many cycles lie between two of them.
//  - A node that start_at() refuses is a wrong choice. Nodes that start_above() has given exist.
class RayEntry {
 public:
  static constexpr PolicyKind kKind{"rt.entry", "rtunit/entries"};
  static constexpr std::string_view kRoot = "root";  // Under this name the unit has no part for look-ups.
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
    const mem::AddressSpace& memory;
  };
  // Says how long look-ups take: `units` of them start in each `interval`, and each takes `latency`.
  struct Timing {
    uint32_t latency = 1, interval = 1, units = 1;  // the first two in cycles
  };
  // Says what became of a ray that was looked up.
  struct Ending {
    bool was_predicted = false;    // look_up() gave a node
    bool was_verified = false;     // and its subtree held a hit.
    std::optional<Start> learned;  // what learn() said of the ray's last hit
  };
  virtual ~RayEntry() = default;
  virtual Timing timing() const { return {}; }
  // Returns whether look_up() and learn() read RayState::path.
  virtual bool wants_path() const { return false; }
  // Returns whether a new ray is looked up. The unit asks only for rays that can need no shader.
  virtual bool wants(const Ray&) const { return false; }
  // Returns the node where the ray should begin. None: it begins at the root.
  virtual std::optional<Start> look_up(const RayState&) { return std::nullopt; }
  // Returns where rays like this one should begin, now that it has found `hit` in the node that it visited
  // last. Only what it says of the ray's last hit is kept.
  virtual std::optional<Start> learn(const RayState&, const Hit& /*hit*/) { return std::nullopt; }
  // Tells that a ray that was looked up has ended. RayState::committed is its hit.
  virtual void ended(const RayState&, const Ending&) {}
};

}  // namespace glint::rt
