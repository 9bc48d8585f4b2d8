// Turns allocated virtual code into an isa::Program: operand slots, constant rows, layout, branches and
// labels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "frontend/backend/allocate.h"

namespace glint::frontend {

// Holds the constant rows of a program, each value once.
class ConstantTable {
 public:
  isa::Slot word(uint32_t value);  // one row
  isa::Slot pair(uint64_t value);  // two consecutive rows, low half first
  std::vector<uint32_t> take() { return std::move(rows_); }

 private:
  std::vector<uint32_t> rows_;
  std::map<uint32_t, isa::Slot> words_;
  std::map<uint64_t, isa::Slot> pairs_;
};

// Encodes `program`, which has no SaveLive or RestoreLive left. It omits instructions that the allocation has
// made useless (moves of a register onto itself), blocks that control cannot reach, and branches to the next
// instruction. Branches to branches go straight to the end.
isa::Program emit(const VirtualProgram& program, const Allocation& allocation, const Ops& ops);

}  // namespace glint::frontend
