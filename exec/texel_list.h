// Lists the texels that one image instruction touches, for the timing of its memory accesses.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "base/types.h"
#include "exec/image_view.h"

namespace glint::exec {

// The most texels of one lane are those of an anisotropic filter: so many samples, each of four texels on two
// levels. A linear filter in three dimensions has 16.
inline constexpr uint32_t kMaxTexels = kMaxAnisotropy * 8;

// Holds virtual addresses, row by row: the first texel of each lane, then the second of each that has one. A
// texel is aligned to its size, so it lies in one sector, and so is a block. Model: of a format with blocks,
// each texel reads its block as it lies in memory, and decoding takes no time.
class TexelList {
 public:
  static constexpr Address kNone = 0;  // No allocation holds address 0.
  void clear() { count_ = 0; }
  void add(int lane, std::span<const Address> texels) {
    for (size_t k = 0; k < texels.size(); ++k) {
      if (k == count_) rows_[count_++].fill(kNone);
      rows_[k][size_t(lane)] = texels[k];
    }
  }
  bool empty() const { return count_ == 0; }
  std::span<const std::array<Address, kLanes>> rows() const { return {rows_.data(), count_}; }

 private:
  size_t count_ = 0;
  std::array<std::array<Address, kLanes>, kMaxTexels> rows_;
};

}  // namespace glint::exec
