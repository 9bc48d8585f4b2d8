// From allocated virtual code to isa::Program: operand slots, constant rows, layout, branches and labels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>

#include "frontend/backend/allocate.h"

namespace glint::frontend {

// Constant rows of a program, each value once.
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

// Encodes `program`, in which no SaveLive or RestoreLive is left. Instructions that the allocation has made
// useless (moves onto themselves), blocks that control cannot reach and branches to the next instruction are
// left out; branches to branches go straight to the end.
isa::Program emit(const VirtualProgram& program, const Allocation& allocation, const Ops& ops);

}  // namespace glint::frontend
