// Spreads chunks of memory over L2 slices as two GPUs with 80 and 96 slices do.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace glint::mem {

// Returns the finaliser of MurmurHash3 (Appleby), in which every input bit reaches every output bit.
inline uint64_t mixed_bits(uint64_t x) {
  x = (x ^ (x >> 33)) * 0xff51'afd7'ed55'8ccdull;
  x = (x ^ (x >> 33)) * 0xc4ce'b9fe'1a85'ec53ull;
  return x ^ (x >> 33);
}

// Tells the slice of each chunk when the number of slices is 16 times 4, 5, 6 or 8. Source:
// bench/probes/slices.cu finds the slice of each line of an H100 (80 slices) and an H200 (96). The rules
// below have the largest share of a slice that was measured for ranges of 64 KB to 1 MB, from 1.25 times the
// mean to 1.02 times on 80 slices.
//
// Four chunks are a block, which takes two slices in turn. Sixteen blocks are a unit, which has 32 slices:
// four of the classes of eight slices that one half of the slices consists of. Units take the halves in turn.
// With more than four classes in a half, a unit leaves some out: those that a window favours are never left
// out in it, and each of the other four is left out twice. Windows favour classes in turn, so all slices have
// the same share of a period of windows, and the chunks of a slice have numbers without gaps. Choice: the
// order of blocks in a unit, and of the units of a window, is not the measured one.
class SliceClasses {
 public:
  static constexpr bool fits(uint32_t slices) {
    return slices == 64 || slices == 80 || slices == 96 || slices == 128;
  }

  explicit constexpr SliceClasses(uint32_t slices) : half_(slices / 2), classes_(slices / 16) {
    const uint32_t missed = classes_ - kTaken;
    const uint32_t window = missed ? 8 / missed : 1;
    period_ = missed ? window * (classes_ / missed) : 1;
    std::array<uint8_t, kMostClasses> count{};
    for (uint32_t unit = 0; unit < period_; ++unit) {
      ranks_[unit] = count;
      const uint32_t favoured = unit / window * missed, first = unit % window * missed;
      uint32_t taken = 0, other = 0;
      for (uint32_t c = 0; c < classes_; ++c) {
        const bool is_favoured = c >= favoured && c < favoured + missed;
        if (!is_favoured && (other++ + kTaken - first % kTaken) % kTaken < missed) continue;
        taken_[unit][taken++] = uint8_t(c);
        ++count[c];
      }
    }
    share_ = count[0];
  }

  uint32_t slice(uint64_t chunk) const {
    const uint64_t unit = chunk >> kUnitBits, bits = mixed_bits(unit);
    const uint32_t block = block_of(chunk, bits);
    const auto side = uint32_t((chunk ^ (bits >> 48)) & 1);
    return half_of(unit) * half_ + class_of(unit, block) * 8 + (block & 3) * 2 + side;
  }
  // Returns the number of the chunk among those of its slice.
  uint64_t rank(uint64_t chunk) const {
    const uint64_t unit = chunk >> kUnitBits, pair = unit >> 1;
    const uint32_t block = block_of(chunk, mixed_bits(unit));
    const uint64_t units = pair / period_ * share_ + ranks_[pair % period_][class_of(unit, block)];
    return units * 2 + (chunk >> 1 & 1);
  }

 private:
  static constexpr uint32_t kTaken = 4;  // number of classes of a unit
  static constexpr uint32_t kMostClasses = 8, kMostUnits = 40;
  static constexpr uint32_t kUnitBits = 6;
  // The halves change places every 16 units, as measured.
  static uint32_t half_of(uint64_t unit) { return uint32_t((unit ^ (unit >> 4)) & 1); }
  // Returns the place of the chunk's block in its unit, of whose number `bits` are the mixed bits.
  static uint32_t block_of(uint64_t chunk, uint64_t bits) {
    return uint32_t(((chunk >> 2) ^ (bits >> 40)) & 15);
  }
  uint32_t class_of(uint64_t unit, uint32_t block) const { return taken_[(unit >> 1) % period_][block >> 2]; }

  uint32_t half_, classes_;
  uint32_t period_ = 1, share_ = 1;  // number of units of a half; how many of them a class has
  std::array<std::array<uint8_t, kTaken>, kMostUnits> taken_{};
  std::array<std::array<uint8_t, kMostClasses>, kMostUnits> ranks_{};  // number of a class's earlier units
};

// Returns the classes of 64, 80, 96 or 128 slices.
inline const SliceClasses& slice_classes(uint32_t slices) {
  static constexpr SliceClasses kOf64{64}, kOf80{80}, kOf96{96}, kOf128{128};
  return slices == 64 ? kOf64 : slices == 80 ? kOf80 : slices == 96 ? kOf96 : kOf128;
}

}  // namespace glint::mem
