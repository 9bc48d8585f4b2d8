// Lets two policies of one cache compete in a few sets each, and says which of them the other sets follow.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "memsys/replacement.h"

namespace glint::mem {

// This is set duelling (Qureshi et al., ISCA 2007). Some sets always use the first policy and some the
// second. A counter rises with each miss in a set of the first policy and falls with each in one of the
// second. The upper half of its range says that the first misses more, and then the other sets use the
// second. Choice: The sets lie in regions of equal size, and each region has one set of either policy, at
// places that differ from region to region, as in the paper's selection by complements. A cache of one set
// has no duel and uses the first policy.
class SetDuel {
 public:
  // `leaders` is the number of sets that use each policy always. A small cache has fewer.
  SetDuel(uint32_t sets, uint32_t leaders, uint32_t bits)
      : leaders_(std::min(leaders, sets / 2)),
        region_(leaders_ ? sets / leaders_ : 1),
        middle_(1u << (bits - 1)),
        counter_(middle_ - 1) {}

  bool uses_second(uint32_t set) const {
    const Role role = role_of(set);
    return role == Role::Second || (role == Role::Follower && counter_ >= middle_);
  }
  void missed(uint32_t set) {
    const Role role = role_of(set);
    if (role == Role::First) counter_ = std::min(counter_ + 1, 2 * middle_ - 1);
    if (role == Role::Second && counter_ > 0) --counter_;
  }

 private:
  enum class Role : uint8_t { First, Second, Follower };
  Role role_of(uint32_t set) const {
    const uint32_t region = set / region_, place = set % region_;
    if (region >= leaders_) return Role::Follower;
    const uint32_t first = region % (region_ / 2);
    if (place == first) return Role::First;
    return place == region_ - 1 - first ? Role::Second : Role::Follower;
  }

  const uint32_t leaders_, region_, middle_;
  uint32_t counter_;  // 0 to 2 * middle_ - 1
};

}  // namespace glint::mem
