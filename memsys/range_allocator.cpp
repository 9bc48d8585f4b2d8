// Finds the lowest gap that is large enough, and joins gaps that touch.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/range_allocator.h"

#include <algorithm>
#include <iterator>

#include "base/check.h"

namespace glint::mem {

RangeAllocator::Gaps::const_iterator RangeAllocator::gap_of(uint64_t count) const {
  return std::find_if(free_.begin(), free_.end(), [&](const auto& gap) { return gap.second >= count; });
}

bool RangeAllocator::has_room(uint64_t count) const {
  return count <= limit_ - end_ || gap_of(count) != free_.end();
}

std::optional<uint64_t> RangeAllocator::take(uint64_t count) {
  if (count == 0) return end_;
  const auto gap = gap_of(count);
  if (gap == free_.end()) {
    if (count > limit_ - end_) return {};
    end_ += count;
    return end_ - count;
  }
  const auto [first, size] = *gap;
  free_.erase(gap);
  if (size > count) free_.emplace(first + count, size - count);
  gaps_ -= count;
  return first;
}

void RangeAllocator::give_back(uint64_t first, uint64_t count) {
  if (count == 0) return;
  GLINT_CHECK_LE(first + count, end_);
  gaps_ += count;
  auto next = free_.lower_bound(first);
  if (next != free_.end() && first + count == next->first) {
    count += next->second;
    next = free_.erase(next);
  }
  if (next != free_.begin()) {
    const auto previous = std::prev(next);
    GLINT_CHECK_LE(previous->first + previous->second, first);
    if (previous->first + previous->second == first) {
      first = previous->first;
      count += previous->second;
      free_.erase(previous);
    }
  }
  if (first + count < end_) {
    free_.emplace(first, count);
  } else {
    gaps_ -= count;
    end_ = first;
  }
}

}  // namespace glint::mem
