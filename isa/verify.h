// Checks that a machine can run a program, so that mistakes of the compiler or of an assembler file are
// found.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "base/diagnostics.h"
#include "isa/program.h"

namespace glint::isa {

// Reports every mistake with its instruction index and, if known, its source line. Mistakes of single
// instructions are: unknown ops, operands of the wrong bank or out of range, odd pairs, guards, targets, ops
// and specials of other stages, constant addresses out of range. If there are none, the paths are checked
// (isa/verify_flow.h): joins outside their regions, code that no lane reaches or that runs off its end,
// registers that nothing has written, accesses outside of frames. The machines run an accepted program
// without a fault of control flow; accesses to memory and rays may still fault.
void verify(const Program& program, Diagnostics& diagnostics);

}  // namespace glint::isa
