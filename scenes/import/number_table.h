// Finds equal things by their numbers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace glint::scenes {

// Holds the numbers of things that differ from each other, in a table that is at most half full. A search
// then touches little memory, because the things lie elsewhere: things.hash(n) is the hash of thing n, and
// things.same(a, b) says whether two things are equal.
template <class Things>
class NumberTable {
 public:
  explicit NumberTable(Things things) : things_(std::move(things)) {}

  // Returns the number of the first thing that is equal to thing `number`. This is `number` itself when it is
  // the first one, and then it is kept.
  uint32_t first_of(uint32_t number) {
    if (2 * (size_ + 1) > places_.size()) grow();
    uint32_t& place = place_of(number);
    if (place == kNone) place = number, ++size_;
    return place;
  }

 private:
  static constexpr uint32_t kNone = UINT32_MAX;
  static constexpr size_t kLeast = 1024;

  // Returns the place that holds a thing equal to this one, or the free place where its number belongs.
  uint32_t& place_of(uint32_t number) {
    const size_t mask = places_.size() - 1;
    size_t at = things_.hash(number) & mask;
    while (places_[at] != kNone && !things_.same(places_[at], number)) at = (at + 1) & mask;
    return places_[at];
  }

  void grow() {
    std::vector<uint32_t> smaller(std::max(kLeast, 2 * places_.size()), kNone);
    smaller.swap(places_);
    for (const uint32_t number : smaller)
      if (number != kNone) place_of(number) = number;
  }

  Things things_;
  size_t size_ = 0;
  std::vector<uint32_t> places_;  // The count of places is a power of two.
};

}  // namespace glint::scenes
