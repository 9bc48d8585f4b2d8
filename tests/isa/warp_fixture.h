// Provides a warp with its own registers, constants and predicates, on which tests run op handlers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "isa/op_row.h"

namespace glint::isa {

// Fills registers with values that differ from row to row and from lane to lane, so that a lost lane shows.
class WarpFixture {
 public:
  WarpFixture() {
    warp.bank = {&storage_[0].lane[0], &storage_[kRows].lane[0], &storage_[2 * kRows].lane[0]};
    for (int row = 0; row < 3 * kRows; ++row)
      for (int lane = 0; lane < kLanes; ++lane)
        storage_[row].lane[lane] = 0xdead'0000u + uint32_t(row * kLanes + lane);
  }
  uint32_t& at(int row, int lane) { return warp.bank[0][row * kLanes + lane]; }

  // Writes a value of the width of `kind` to the row (or pair of rows) or the predicate of `slot`.
  void set(OperandKind kind, Slot slot, int lane, uint64_t value) {
    if (kind == OperandKind::SrcPred || kind == OperandKind::DstPred) {
      const LaneMask bit = LaneMask{1} << lane;
      warp.predicate[slot] = value ? warp.predicate[slot] | bit : warp.predicate[slot] & ~bit;
      return;
    }
    at(slot, lane) = uint32_t(value);
    if (is_wide(kind)) at(slot + 1, lane) = uint32_t(value >> 32);
  }
  uint64_t get(OperandKind kind, Slot slot, int lane) {
    if (kind == OperandKind::SrcPred || kind == OperandKind::DstPred) return warp.predicate[slot] >> lane & 1;
    return at(slot, lane) | (is_wide(kind) ? uint64_t{at(slot + 1, lane)} << 32 : 0);
  }
  static bool is_wide(OperandKind kind) {  // DstVec2 of unpack.b64: tests put its parts side by side
    return kind == OperandKind::Dst64 || kind == OperandKind::Src64 || kind == OperandKind::DstVec2;
  }
  // Returns every register and predicate, to compare whole warps.
  std::vector<uint32_t> snapshot() const {
    std::vector<uint32_t> out(warp.predicate.begin(), warp.predicate.end());
    out.insert(out.end(), warp.bank[0], warp.bank[0] + kRows * kLanes);
    return out;
  }

  Warp warp;
  static constexpr int kRows = 32;

 private:
  struct alignas(64) Lanes {
    uint32_t lane[kLanes];
  };
  std::vector<Lanes> storage_ = std::vector<Lanes>(3 * kRows);
};

// Returns an instruction of `row` whose operand number n lies at row 2n, or is predicate n.
inline Inst spread(const OpRow& row, uint16_t op) {
  Inst inst;
  inst.op = op;
  int slot = 0, n = 0;
  for (const OperandKind kind : row.operands.view()) {
    const bool is_predicate = kind == OperandKind::SrcPred || kind == OperandKind::DstPred;
    for (int i = 0; i < slots_of(kind); ++i)
      inst.operand[slot++] = Slot(is_predicate ? n % kNumPredicates : 2 * n + i);
    n += slots_of(kind) > 2 ? 2 : 1;
  }
  return inst;
}

inline bool is_value_op(const OpRow& row) {
  return row.effect == Effect::None;
}

}  // namespace glint::isa
