// Remembers which lines of physical memory a cache has ever held.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/types.h"

namespace glint::mem {

// Holds one bit for each line, in pages that are made when their first line comes. Physical memory is packed
// densely, so neighbouring lines share a word, and most questions need no memory of the host that is not in
// its caches.
class LineSet {
 public:
  explicit LineSet(uint32_t line_bytes) : line_shift_(uint32_t(std::countr_zero(line_bytes))) {}

  // Inserts the line at `line` if it is absent. Returns whether it was absent.
  bool insert_if_new(Address line) {
    const Address number = line >> line_shift_;
    uint64_t& word = page_of(number)[number / 64 % kWords];
    const uint64_t bit = uint64_t{1} << number % 64;
    const bool is_new = !(word & bit);
    word |= bit;
    return is_new;
  }

 private:
  static constexpr size_t kWords = 512;
  using Page = std::array<uint64_t, kWords>;

  Page& page_of(Address number) {
    const auto index = size_t(number / 64 / kWords);
    if (index >= pages_.size()) [[unlikely]]
      pages_.resize(index + 1);
    if (!pages_[index]) [[unlikely]]
      pages_[index] = std::make_unique<Page>();
    return *pages_[index];
  }

  uint32_t line_shift_;  // a line has 1 << line_shift_ bytes
  std::vector<std::unique_ptr<Page>> pages_;
};

}  // namespace glint::mem
