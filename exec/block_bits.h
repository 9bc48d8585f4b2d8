// Reads what BC6H and BC7 have in common: the bits of a block, its subsets and its indices.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "exec/block_partitions.h"

namespace glint::exec {

// Reads the 128 bits of a block from the lowest one on.
class BlockBits {
 public:
  explicit BlockBits(const std::byte* block) { std::memcpy(words_.data(), block, sizeof words_); }
  // Returns `count` bits, of at most 32, from bit `at` on.
  uint32_t at(uint32_t at, uint32_t count) const {
    uint64_t bits = words_[at / 64] >> at % 64;
    if (at / 64 == 0 && at > 0) bits |= words_[1] << (64 - at);
    return uint32_t(bits & ((uint64_t{1} << count) - 1));
  }
  uint32_t take(uint32_t count) {
    const uint32_t out = count ? at(next_, count) : 0;
    next_ += count;
    return out;
  }
  uint32_t next() const { return next_; }  // the bit that take() reads next

 private:
  std::array<uint64_t, 2> words_;
  uint32_t next_ = 0;
};

// Says how a block is divided: into 1, 2 or 3 subsets, by which row of the tables.
struct BlockSubsets {
  uint32_t count = 1, partition = 0;

  uint32_t of(uint32_t texel) const {
    return count == 1   ? 0
           : count == 2 ? kSubsetsOfTwo[partition] >> texel & 1u
                        : kSubsetsOfThree[partition] >> 2 * texel & 3u;
  }
  uint32_t anchor(uint32_t subset) const {
    return subset == 0   ? 0
           : count == 2  ? kAnchorsOfTwo[partition]
           : subset == 1 ? kSecondAnchorsOfThree[partition]
                         : kThirdAnchorsOfThree[partition];
  }
};

// Returns the weight of the second endpoint, of 64, at a texel whose indices of `width` bits begin at bit
// `first`. An anchor's index lacks its highest bit.
inline uint32_t block_weight(const BlockBits& bits, const BlockSubsets& subsets, uint32_t texel,
                             uint32_t first, uint32_t width) {
  uint32_t before = 0, missing = 0;
  for (uint32_t subset = 0; subset < subsets.count; ++subset) {
    before += subsets.anchor(subset) < texel;
    missing |= uint32_t(subsets.anchor(subset) == texel);
  }
  const uint32_t index = bits.at(first + width * texel - before, width - missing);
  if (width == 2) return index * 21 + (index >> 1);
  if (width == 3) return index * 9 + (index >> 2);
  return (index << 2) + (index >> 2) + (index >> 1 & 1);
}

}  // namespace glint::exec
