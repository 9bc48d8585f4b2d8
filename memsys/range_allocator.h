// Hands out ranges of numbers, and takes them back: physical addresses, and the numbers of allocations.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>

namespace glint::mem {

// Hands out ranges of the numbers [0, limit). A range lies as low as possible, so that ranges that are given
// back in reverse order leave no trace.
class RangeAllocator {
 public:
  explicit RangeAllocator(uint64_t limit) : limit_(limit) {}

  // Returns the first of `count` consecutive numbers, or nothing when no gap is large enough. With a count of
  // 0 it returns end().
  std::optional<uint64_t> take(uint64_t count);
  bool has_room(uint64_t count) const;  // whether take() would return a number
  // Takes back a range or a part of one that take() returned.
  void give_back(uint64_t first, uint64_t count);

  uint64_t limit() const { return limit_; }
  uint64_t end() const { return end_; }                // one past the highest number that is taken
  uint64_t num_taken() const { return end_ - gaps_; }  // numbers that are taken now

 private:
  using Gaps = std::map<uint64_t, uint64_t>;
  Gaps::const_iterator gap_of(uint64_t count) const;

  uint64_t limit_;
  uint64_t end_ = 0;
  uint64_t gaps_ = 0;  // numbers below end_ that are free
  Gaps free_;          // first -> count of the gaps below end_, none of which touch
};

}  // namespace glint::mem
