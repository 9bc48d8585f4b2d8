// Keeps the slots of each set in an order from newest to oldest, for the policies `lru` and `fifo`.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "memsys/replacement.h"

namespace glint::mem {

// Each set is a doubly linked list, so that a set of 512 ways costs as much as a set of 4.
class SlotOrder {
 public:
  explicit SlotOrder(const Replacement::Context& context)
      : ways_(context.ways),
        links_(size_t{context.sets} * context.ways),
        newest_(context.sets),
        oldest_(context.sets) {
    for (uint32_t set = 0; set < context.sets; ++set) {
      newest_[set] = set * ways_;
      oldest_[set] = set * ways_ + ways_ - 1;
      for (uint32_t slot = newest_[set]; slot < oldest_[set]; ++slot)
        links_[slot].older = slot + 1, links_[slot + 1].newer = slot;
    }
  }

  void make_newest(uint32_t slot) {
    Link& link = links_[slot];
    if (link.newer == kNone) return;
    const uint32_t set = newest_.size() == 1 ? 0 : slot / ways_;
    links_[link.newer].older = link.older;
    (link.older == kNone ? oldest_[set] : links_[link.older].newer) = link.newer;
    link.newer = kNone;
    link.older = newest_[set];
    links_[newest_[set]].newer = slot;
    newest_[set] = slot;
  }
  uint32_t oldest_not_held(uint32_t set, std::span<const CacheLine> lines) const {
    uint32_t slot = oldest_[set];
    while (slot != kNone && lines[slot].held) slot = links_[slot].newer;
    return slot;
  }

 private:
  static constexpr uint32_t kNone = Replacement::kNone;
  struct Link {
    uint32_t newer = kNone, older = kNone;
  };

  const uint32_t ways_;
  std::vector<Link> links_;                // by slot
  std::vector<uint32_t> newest_, oldest_;  // by set
};

}  // namespace glint::mem
