// Declares the interface of the policies that choose which lanes share one fetch of a node.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "rtunit/ray_scheduler.h"

namespace glint::rt {

// Contract (tests/contract/rt_coalescer_test.cpp):
//  - partners() is 0, or has the bit of `picked` and otherwise only bits of warps that are ready.
//  - The choice depends on the arguments alone.
class Coalescer {
 public:
  static constexpr PolicyKind kKind{"rt.coalescing", "rtunit/coalescers"};
  struct Context {};
  virtual ~Coalescer() = default;
  // Returns the warps, as a mask of their slots, whose lanes share the fetch made for a lane of `picked` when
  // they want the same node. 0 means that no lane shares it, not even one of the same warp.
  virtual uint64_t partners(uint32_t picked, std::span<const WarpView> warps) const = 0;
};

}  // namespace glint::rt
