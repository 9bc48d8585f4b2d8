// Names the range checks of divisions, reciprocals and square roots, and the time of the routines that take
// the operands which they find.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/types.h"
#include "isa/inst.h"
#include "isa/warp.h"

namespace glint::core {

// Names a check. An op that rounds correctly is a short sequence with a check, and a branch to a routine that
// the warp calls if any of its lanes fails.
// `Ftz`: subnormal operands and results count as zero. Model: these have the times of those without it.
enum class SlowPath : uint8_t {
  None,
  DivF32,
  DivFtzF32,
  RcpF32,
  SqrtF32,
  SqrtFtzF32,
  DivF64,
  RcpF64,
  SqrtF64
};

// Holds what a routine adds to the short sequence.
struct SlowTime {
  uint32_t issues = 0;   // machine instructions
  uint32_t latency = 0;  // cycles
};

// Returns what the operands of `inst` in `lanes` add, before the instruction is executed. Lanes that take
// different ways through the routine take them one after another.
SlowTime slow_time(SlowPath path, const isa::Warp& warp, const isa::Inst& inst, LaneMask lanes);

}  // namespace glint::core
