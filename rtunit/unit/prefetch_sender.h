// Tells a prefetcher what the rays do, and sends what it asks for while the port is free.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>

#include "memsys/address_space.h"
#include "memsys/l1_port.h"
#include "rtunit/prefetcher.h"
#include "rtunit/unit/fetch_queue.h"
#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

// Model: a prefetch reads one 32 B sector, and the queue is cleared when the last warp leaves the unit.
class PrefetchSender final : public WalkHook, public WarpExit, public DemandListener {
 public:
  PrefetchSender(const Params& params, const mem::AddressSpace& memory, mem::L1Port& l1,
                 const WarpBuffer& buffer, RtStats& stats);

  void entered(uint32_t slot, int lane, Cycle now) override;
  void visited(const Visit& visit) override { policy_->visited(visit); }
  bool holds(uint32_t slot, Cycle now) override;
  void demanded(Address from, uint32_t bytes, Cycle now) override;
  TreeletId treelet_ahead() const override { return policy_->treelet_ahead(); }

  // Offers the first sector of the queue to the L1, in a cycle in which nothing else was sent. Returns
  // whether the L1 took it.
  bool send(Cycle now);
  Cycle next_event(Cycle now) const { return queue_.empty() ? kNever : now + 1; }

 private:
  const mem::AddressSpace& memory_;
  mem::L1Port& l1_;
  const WarpBuffer& buffer_;
  PrefetchQueue queue_;
  const std::unique_ptr<Prefetcher> policy_;
};

}  // namespace glint::rt
