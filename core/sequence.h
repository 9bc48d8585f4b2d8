// Holds the rest of a sequence: the machine instructions that one ISA instruction stands for, or a prologue.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/types.h"

namespace glint::core {

// Says what is left of a sequence. The effect of the instruction has happened with the first machine
// instruction, and the pipe is taken. The others follow in even steps, and the result comes behind the last.
// Each takes an issue slot of its warp. Model: only the first machine instruction takes a pipe, for the
// interval of the whole. The next instruction of the warp does not issue in between, although an assembler
// would mix the two.
struct Sequence {
  static constexpr uint32_t kPrologue = ~0u;
  uint32_t left = 0;        // machine instructions that still have to issue
  uint32_t pc = kPrologue;  // the ISA's instruction; kPrologue: the sequence precedes the kernel
  Cycle step = 1;           // cycles from one machine instruction to the next
  Cycle last = 1;           // cycles from the last one to the result
  bool is_under_way() const { return left > 0; }
  bool is_prologue() const { return pc == kPrologue; }
};

}  // namespace glint::core
