// Keeps the slots of each set in an order from newest to oldest, for the policies `lru` and `fifo`.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "memsys/replacement.h"

namespace glint::mem {

// The order of a small set is a string of bytes, which seldom needs more than one cache line of the host.
// Each large set is a doubly linked list, so that a set of 512 ways costs as much as a set of 4.
class SlotOrder {
 public:
  explicit SlotOrder(const Replacement::Context& context)
      : ways_(context.ways),
        is_small_(context.ways <= kSmall),
        ways_by_age_(is_small_ ? size_t{context.sets} * context.ways : 0),
        links_(is_small_ ? 0 : size_t{context.sets} * context.ways),
        newest_(is_small_ ? 0 : context.sets),
        oldest_(is_small_ ? 0 : context.sets) {
    for (size_t i = 0; i < ways_by_age_.size(); ++i) ways_by_age_[i] = uint8_t(i % ways_);
    for (uint32_t set = 0; set < newest_.size(); ++set) {
      newest_[set] = set * ways_;
      oldest_[set] = set * ways_ + ways_ - 1;
      for (uint32_t slot = newest_[set]; slot < oldest_[set]; ++slot)
        links_[slot].older = slot + 1, links_[slot + 1].newer = slot;
    }
  }

  void make_newest(uint32_t slot) {
    if (is_small_) return make_newest_of_few(slot);
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
  // Brings the order of a small set near to the host's core.
  void prefetch(uint32_t set) const {
    if (is_small_) __builtin_prefetch(&ways_by_age_[size_t{set} * ways_], 1);
  }
  uint32_t oldest_not_held(uint32_t set, std::span<const CacheLine> lines) const {
    if (is_small_) {
      const uint32_t first = set * ways_;
      for (uint32_t age = ways_; age-- > 0;)
        if (const uint32_t slot = first + ways_by_age_[first + age]; !lines[slot].held) return slot;
      return kNone;
    }
    uint32_t slot = oldest_[set];
    while (slot != kNone && lines[slot].held) slot = links_[slot].newer;
    return slot;
  }

 private:
  static constexpr uint32_t kNone = Replacement::kNone;
  static constexpr uint32_t kSmall = 32;  // Choice: sets of at most this many ways are small.
  struct Link {
    uint32_t newer = kNone, older = kNone;
  };

  // Moves the ways that are newer than the slot's by one place.
  void make_newest_of_few(uint32_t slot) {
    const auto way = uint8_t(slot % ways_);
    uint8_t* age = ways_by_age_.data() + (slot - way);
    for (uint8_t moved = way;; ++age) {
      std::swap(*age, moved);
      if (moved == way) return;
    }
  }

  const uint32_t ways_;
  const bool is_small_;
  std::vector<uint8_t> ways_by_age_;       // of small sets: ways from newest to oldest, set by set
  std::vector<Link> links_;                // of large sets, by slot
  std::vector<uint32_t> newest_, oldest_;  // of large sets, by set
};

}  // namespace glint::mem
