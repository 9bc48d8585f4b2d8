// Declares the interface of the policies that read nodes ahead of the rays that will want them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "base/registry.h"
#include "base/stats.h"
#include "memsys/address_space.h"
#include "rtunit/prefetch_queue.h"
#include "rtunit/treelets.h"
#include "rtunit/visit.h"

namespace glint::rt {

// A prefetcher sees what the rays do and puts sectors into the unit's queue. The unit sends one of them in
// each cycle in which it sends nothing else, as a read that nobody waits for (mem::Traffic::RtPrefetch). A
// sector leaves the queue when a ray asks for it first.
//
// Contract (tests/contract/rt_prefetcher_test.cpp):
//  - No call changes a ray. So a prefetcher changes cycles, never hits.
//  - What is asked for depends on the calls alone, and not on how many cycles lie between two of them.
//  - A prefetcher asks for sectors that hold nodes. The queue drops addresses outside memory.
class Prefetcher {
 public:
  static constexpr PolicyKind kKind{"rt.prefetch", "rtunit/prefetchers"};
  static constexpr std::string_view kNone = "none";  // Under this name the unit has no part for prefetches.
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
    PrefetchQueue& queue;
    const mem::AddressSpace& memory;
    uint32_t warps = 0;  // slots of the warp buffer
  };
  virtual ~Prefetcher() = default;
  // Returns whether the prefetcher goes by treelets, which not every layout forms (bvh.layout).
  virtual bool needs_treelets() const { return false; }
  // Returns the treelet that is being read ahead, for ray schedulers that prefer its warps.
  virtual TreeletId treelet_ahead() const { return kNoTreelet; }
  // Tells that a ray begins, or goes on after a shader, in a lane of a warp that takes the slot.
  virtual void entered(uint32_t /*slot*/, int /*lane*/, const RayState& /*ray*/, Cycle /*now*/) {}
  // Tells that a ray has made the step of a node.
  virtual void visited(const Visit&) {}
  // Tells that the L1 has taken a ray's own request for `bytes` from the virtual address on.
  virtual void demanded(Address /*from*/, uint32_t /*bytes*/, Cycle /*now*/) {}
  // Tells that the warp in the slot has no more nodes to visit.
  virtual void left(uint32_t /*slot*/, Cycle /*now*/) {}
};

}  // namespace glint::rt
