// Sends prefetches in the cycles that the rays leave free.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/prefetch_sender.h"

#include <cstdint>

namespace glint::rt {

PrefetchSender::PrefetchSender(const Params& params, const mem::AddressSpace& memory, mem::L1Port& l1,
                               const WarpBuffer& buffer, RtStats& stats)
    : memory_(memory),
      l1_(l1),
      buffer_(buffer),
      queue_(params.prefetch_queue, memory, &stats),
      policy_(params.prefetch.make({&stats, queue_, memory, params.slots()})) {
}

void PrefetchSender::entered(uint32_t slot, int lane, Cycle now) {
  policy_->entered(slot, lane, buffer_[slot].ray_of(lane), now);
}

bool PrefetchSender::holds(uint32_t slot, Cycle now) {
  policy_->left(slot, now);
  if (buffer_.num_rays() == 0) queue_.clear();
  return false;
}

void PrefetchSender::demanded(Address from, uint32_t bytes, Cycle now) {
  queue_.remove(from, bytes);
  policy_->demanded(from, bytes, now);
}

bool PrefetchSender::send(Cycle now) {
  if (queue_.empty()) return false;
  const Address at = memory_.physical(queue_.front()), offset = at & (l1_.line_bytes() - 1);
  mem::Request request;
  request.line = at - offset;
  request.sectors = uint8_t(1u << offset / mem::kSectorBytes);
  request.traffic = mem::Traffic::RtPrefetch;
  const bool is_taken = l1_.access(now, mem::Client::RtUnit, request);
  queue_.note_sent(is_taken);
  return is_taken;
}

}  // namespace glint::rt
