// Lets a traversal order choose which of a ray's open nodes is next.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <utility>

#include "base/stats.h"
#include "memsys/address_space.h"
#include "rtunit/traversal_order.h"
#include "rtunit/unit/walk_hook.h"

namespace glint::rt {

struct OrderStats {
  explicit OrderStats(stats::Group* parent) : group(parent, "order") {}
  stats::Group group;
  stats::Counter arranged{&group, "arranged", "visit",
                          "Number of visits after which the order of a ray's open nodes was chosen."};
  stats::Counter without_room{
      &group, "without_room", "visit",
      "Number of visits after which it stayed depth first, because the ray's stack might not have had room."};
};

// Model: rearranging takes no time.
class WalkOrder final : public WalkHook {
 public:
  WalkOrder(std::unique_ptr<TraversalOrder> policy, const mem::AddressSpace& memory, stats::Group* stats)
      : policy_(std::move(policy)), memory_(memory), stats_(stats) {}

  void visited(const Visit& visit) override;

 private:
  bool has_room(const RayState& ray) const;

  const std::unique_ptr<TraversalOrder> policy_;
  const mem::AddressSpace& memory_;
  OrderStats stats_;
};

}  // namespace glint::rt
