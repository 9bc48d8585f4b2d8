// Models a resource that serves so much per cycle, for requests that come out of the order of time.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/types.h"

namespace glint::pipeline {

// Cuts time into short spans. Each has room for as many cycles of work as it is long. A request takes room
// from the first span that has any, at or after the request's time. So a reply that comes late does not hold
// up those that come before it. Model: work that lies more than kSpans spans apart does not meet.
class Bandwidth {
 public:
  Bandwidth() : rooms_(kSpans) {}

  // Returns when work that is asked for at `at` begins.
  Cycle begin(Cycle at) const {
    for (uint64_t span = at / kSpan;; ++span) {
      const Room& room = rooms_[span % kSpans];
      if (room.span > span) return at;
      if (room.span < span || room.used < float(kSpan))
        return std::max(at, span * kSpan + (room.span < span ? 0 : Cycle(room.used)));
    }
  }

  // Takes `amount` cycles of work and returns when it begins.
  Cycle take(Cycle at, double amount) {
    total_ += amount;
    const Cycle first = begin(at);
    for (uint64_t span = first / kSpan; amount > 0; ++span) {
      Room& room = rooms_[span % kSpans];
      if (room.span > span) break;
      if (room.span < span) room = {span, 0};
      const double part = std::min(amount, double(kSpan) - double(room.used));
      room.used += float(part);
      amount -= part;
    }
    return first;
  }
  double total() const { return total_; }  // cycles of work

 private:
  static constexpr uint64_t kSpan = 8, kSpans = 4096;
  struct Room {
    uint64_t span = 0;
    float used = 0;
  };
  std::vector<Room> rooms_;
  double total_ = 0;
};

}  // namespace glint::pipeline
