// Says which lane and register of a warp holds which element of a matrix (PTX ISA, "Matrix Fragments for
// mma").
// SPDX-License-Identifier: Apache-2.0
//
// All shapes follow one rule. Lane 4g + t of A holds elements of row g, and of row g + 8 in every second
// register; a register holds kPer neighbours from column t * kPer on, and further registers lie 4 * kPer
// columns on. B is the same with rows and columns exchanged, and has 8 columns. Lane 4g + t of C and D holds
// columns 2t and 2t + 1 of rows g and g + 8. Only files of isa/ops include this file (see op_makers.h).
#pragma once
#include <cstdint>

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

// Describes a product of kM x kK and kK x 8 elements of kBits bits. Matrices are held by columns of A, by
// rows of B and by columns of C and D, so that a loop over the rows of A is a vector.
template <int kRows, int kDepth, int kElementBits>
struct MatrixShape {
  static constexpr int kM = kRows, kK = kDepth, kN = 8, kBits = kElementBits;
  static constexpr int kPer = 32 / kBits;          // elements of a register
  static constexpr int kHalves = kM / 8;           // registers of A that differ in their rows
  static constexpr int kBlocks = kK / (4 * kPer);  // registers of B
  static constexpr int kRegistersA = kHalves * kBlocks, kRegistersB = kBlocks;
  static constexpr int kA = kM * kK, kB = kK * kN, kC = kM * kN;  // elements
  static constexpr uint32_t kMask = kBits == 32 ? ~0u : (1u << (kBits & 31)) - 1;
};

// Writes the bits of A as out[column * kM + row].
template <class S>
[[gnu::always_inline]] inline void read_a(const Warp& warp, const Slot* slot, uint32_t* out) {
  for (int r = 0; r < S::kRegistersA; ++r) {
    const uint32_t* const word = Source<uint32_t>(warp, slot[r]).low;
    const int half = r % S::kHalves, block = r / S::kHalves;
    for (int lane = 0; lane < kLanes; ++lane)
      for (int i = 0; i < S::kPer; ++i)
        out[((block * 4 + lane % 4) * S::kPer + i) * S::kM + half * 8 + lane / 4] =
            word[lane] >> (i * S::kBits) & S::kMask;
  }
}
// Writes the bits of B as out[row * 8 + column].
template <class S>
[[gnu::always_inline]] inline void read_b(const Warp& warp, const Slot* slot, uint32_t* out) {
  for (int r = 0; r < S::kRegistersB; ++r) {
    const uint32_t* const word = Source<uint32_t>(warp, slot[r]).low;
    for (int lane = 0; lane < kLanes; ++lane)
      for (int i = 0; i < S::kPer; ++i)
        out[((r * 4 + lane % 4) * S::kPer + i) * S::kN + lane / 4] = word[lane] >> (i * S::kBits) & S::kMask;
  }
}

// Calls visit(register, lane, shift, element) for each element of C or D, where the element is
// column * kM + row. Elements of 32 bits have a register of their own, and those of 16 bits share one.
template <class S, int kElementBits, class Visit>
[[gnu::always_inline]] inline void for_each_sum(Visit&& visit) {
  constexpr int kPair = kElementBits == 16 ? 1 : 2;  // registers of two neighbours
  for (int half = 0; half < S::kHalves; ++half)
    for (int j = 0; j < 2; ++j)
      for (int lane = 0; lane < kLanes; ++lane)
        visit(half * kPair + (kPair == 2 ? j : 0), lane, kPair == 2 ? 0 : 16 * j,
              (2 * (lane % 4) + j) * S::kM + half * 8 + lane / 4);
}
template <class S, int kElementBits>
[[gnu::always_inline]] inline void read_c(const Warp& warp, const Slot* slot, uint32_t* out) {
  for_each_sum<S, kElementBits>([&](int r, int lane, int shift, int element) {
    const uint32_t word = Source<uint32_t>(warp, slot[r]).low[lane] >> shift;
    out[element] = kElementBits == 16 ? word & 0xffff : word;
  });
}
// Writes D for the lanes of `exec`.
template <class S, int kElementBits>
[[gnu::always_inline]] inline void write_d(Warp& warp, const Slot* slot, const uint32_t* from) {
  const LaneMask exec = warp.exec;
  for_each_sum<S, kElementBits>([&](int r, int lane, int shift, int element) {
    if ((exec >> lane & 1) == 0) return;
    uint32_t& word = (warp.bank[0] + slot[r] * kLanes)[lane];
    word = shift == 0 ? from[element] : word | from[element] << shift;
  });
}

}  // namespace glint::isa::GLINT_ISA_PATH
