// Moves matrices between shared memory and the registers of a warp for ldmatrix and stmatrix.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstring>

#include "exec/memory_ops.h"

namespace glint::exec {

using isa::Effect;
using isa::Space;

namespace {

inline constexpr int kSide = 8;                                 // rows and columns of a matrix
using Matrix = std::array<std::array<uint16_t, kSide>, kSide>;  // by rows, as memory has them

// Calls visit(half, row, column) for the two elements of a lane: lane 4g + t holds columns 2t and 2t + 1 of
// row g, or rows 2t and 2t + 1 of column g of a transposed matrix.
template <class Visit>
void for_each_element(int lane, bool is_transposed, Visit&& visit) {
  for (int half = 0; half < 2; ++half) {
    const auto along = size_t(lane / 4), across = size_t(2 * (lane % 4) + half);
    is_transposed ? visit(half, across, along) : visit(half, along, across);
  }
}

}  // namespace

// Runs an ldmatrix or a stmatrix. Choice: rows that no lane names, because it does not execute, are zeros for
// loads and are not stored, which PTX leaves open. So are rows whose access is let pass and went nowhere.
bool MemoryOps::move_matrices(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row,
                              LaneMask lanes) {
  const int count = row.memory.matrices, rows = count * kSide;
  LaneMask named = rows == kLanes ? lanes : lanes & ((LaneMask{1} << rows) - 1);
  LanePlaces at{};
  if (!locate(warp, row, Space::Shared, named, at)) return false;
  std::array<Matrix, 4> matrices{};
  const bool is_store = row.effect == Effect::Store;
  const size_t first = is_store ? kStoreFirst : kLoadFirst;
  if (!is_store)
    for_each_lane(named, [&](int lane) {
      std::memcpy(&matrices[size_t(lane / kSide)][size_t(lane % kSide)], at[size_t(lane)],
                  sizeof(Matrix{}[0]));
    });
  for (int m = 0; m < count; ++m) {
    const isa::Slot slot = inst.operand[first + size_t(m)];
    for_each_lane(lanes, [&](int lane) {
      uint32_t word = is_store ? warp.regs.read(slot)[lane] : 0;
      for_each_element(lane, row.memory.is_transposed, [&](int half, size_t r, size_t column) {
        uint16_t& element = matrices[size_t(m)][r][column];
        if (is_store)
          element = uint16_t(word >> (16 * half));
        else
          word |= uint32_t{element} << (16 * half);
      });
      if (!is_store) warp.regs.write(slot)[lane] = word;
    });
  }
  if (!is_store) return true;
  ++warp.effects;
  ++changes_;
  for_each_lane(named, [&](int lane) {
    std::memcpy(at[size_t(lane)], &matrices[size_t(lane / kSide)][size_t(lane % kSide)], sizeof(Matrix{}[0]));
  });
  return true;
}

}  // namespace glint::exec
