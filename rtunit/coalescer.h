// Which lanes share one fetch of a node: the interface of coalescing policies.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "base/policy_kinds.h"
#include "rtunit/ray_scheduler.h"

namespace glint::rt {

// Contract (tests/contract/rt_coalescer_test.cpp):
//  - partners() is 0, or has the bit of `picked` and of others only such that are ready;
//  - the choice depends on the arguments alone.
class Coalescer {
 public:
  static constexpr PolicyKind kKind{"rt.coalescing", "rtunit/coalescers"};
  struct Context {};
  virtual ~Coalescer() = default;
  // The warps, as a mask of their slots, whose lanes that want the same node share the fetch made for a lane
  // of `picked`. 0: no lane shares it, of its own warp neither.
  virtual uint64_t partners(uint32_t picked, std::span<const WarpView> warps) const = 0;
};

}  // namespace glint::rt
