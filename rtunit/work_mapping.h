// Declares the interface of the policies that let lanes without work visit nodes for the rays of others.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/registry.h"
#include "base/stats.h"
#include "base/types.h"

namespace glint::rt {

// Holds what a policy may know of the lanes of one warp in the unit.
struct WorkView {
  LaneMask givers =
      0;  // lanes with a node on their stack that they have not asked for and will not ask for next
  LaneMask takers = 0;  // lanes that visit no nodes: their own ray has ended, or they have none
};

// Says that an entry of one lane's stack goes to another lane, which visits it and everything below it.
struct WorkMove {
  int from = 0, to = 0;
  bool takes_bottom = false;  // takes the lowest entry on chip, not the one under the top
};

// Contract (tests/contract/rt_work_mapping_test.cpp):
//  - choose() is asked only when both masks have lanes. The lanes of a move are a giver and a taker.
//  - The choice depends on the argument and the policy's own state only, and an answer of nothing changes no
//    state.
//  - A mapping changes cycles, never hits: the hit of a ray is the nearest of those that all its lanes find.
class WorkMapping {
 public:
  static constexpr PolicyKind kKind{"rt.mapping", "rtunit/mappings"};
  static constexpr std::string_view kOwnRay = "own_ray";  // Under this name no lane ever works for another.
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
  };
  virtual ~WorkMapping() = default;
  // Returns the next move within a warp, if there is to be one.
  virtual std::optional<WorkMove> choose(const WorkView&) { return std::nullopt; }
  // Returns the number of moves that the unit makes in a cycle, in all its warps together.
  virtual uint32_t moves_per_cycle() const { return 1; }
};

}  // namespace glint::rt
