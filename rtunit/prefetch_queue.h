// Holds the sectors that a prefetcher wants to be read ahead, until the RT unit's port is free.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/stats.h"
#include "memsys/address_space.h"
#include "memsys/request.h"
#include "rtunit/traversal/ray_path.h"

namespace glint::rt {

// Every wish is repeated, too many, outside or queued. What was queued is demanded, dropped or sent at last.
struct PrefetchQueueStats {
  explicit PrefetchQueueStats(stats::Group* parent) : group(parent, "prefetch") {}
  stats::Group group;
  stats::Counter wishes{&group, "wishes", "sector", "Number of 32 B sectors that the prefetcher asked for."};
  stats::Counter repeated{&group, "repeated", "sector",
                          "Number of wishes for a sector that was in the queue already."};
  stats::Counter too_many{&group, "too_many", "sector", "Number of wishes that found the queue full."};
  stats::Counter outside{&group, "outside", "sector", "Number of wishes for a sector outside memory."};
  stats::Counter demanded{&group, "demanded", "sector",
                          "Number of queued sectors that left because a ray asked for them first."};
  stats::Counter dropped{&group, "dropped", "sector",
                         "Number of queued sectors that left because no warp was in the unit any more."};
  stats::Counter sent{&group, "sent", "sector", "Number of prefetches that the L1 took."};
  stats::Counter refused{&group, "refused", "attempt", "Number of times that the L1 refused a prefetch."};
};

// Sectors leave in the order in which they came. Addresses are virtual.
class PrefetchQueue {
 public:
  PrefetchQueue(uint32_t entries, const mem::AddressSpace& memory, stats::Group* parent)
      : memory_(memory), stats_(parent), sectors_(entries) {}

  // Asks for all sectors of a node.
  void want(const Fetch& node) {
    for (Address at = sector_of(node.address); at < node.address + node.bytes; at += mem::kSectorBytes)
      want(at);
  }
  // Asks for the sector that holds the byte at `address`.
  void want(Address address) {
    const Address at = sector_of(address);
    ++stats_.wishes;
    if (!memory_.find(at, 1)) {
      ++stats_.outside;
    } else if (std::find(sectors_.begin(), sectors_.begin() + ptrdiff_t(size_), at) !=
               sectors_.begin() + ptrdiff_t(size_)) {
      ++stats_.repeated;
    } else if (size_ == sectors_.size()) {
      ++stats_.too_many;
    } else {
      sectors_[size_++] = at;
    }
  }
  // Removes what a ray has just asked for itself.
  void remove(Address from, uint32_t bytes) {
    const auto end = sectors_.begin() + ptrdiff_t(size_);
    const auto left = std::remove_if(sectors_.begin(), end, [&](Address at) {
      return at + mem::kSectorBytes > from && at < from + bytes;
    });
    stats_.demanded += uint64_t(end - left);
    size_ = size_t(left - sectors_.begin());
  }
  // Removes everything, for a prefetcher that has changed its mind.
  void clear() {
    stats_.dropped += size_;
    size_ = 0;
  }

  bool empty() const { return size_ == 0; }
  size_t size() const { return size_; }
  Address front() const { return sectors_.front(); }
  // Tells whether the L1 took the first sector, which then leaves.
  void note_sent(bool is_taken) {
    ++(is_taken ? stats_.sent : stats_.refused);
    if (!is_taken) return;
    std::copy(sectors_.begin() + 1, sectors_.begin() + ptrdiff_t(size_), sectors_.begin());
    --size_;
  }
  const PrefetchQueueStats& stats() const { return stats_; }

 private:
  static Address sector_of(Address address) { return address & ~Address{mem::kSectorBytes - 1}; }

  const mem::AddressSpace& memory_;
  PrefetchQueueStats stats_;
  std::vector<Address> sectors_;  // The first size_ are valid.
  size_t size_ = 0;
};

}  // namespace glint::rt
