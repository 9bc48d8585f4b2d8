// Checks that a machine can run a program: what the compiler or an assembler file must have got right.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "base/diagnostics.h"
#include "isa/program.h"

namespace glint::isa {

// Reports every mistake, each with instruction index and, if known, source line. Of an instruction alone:
// unknown ops, operands of the wrong bank or out of range, odd pairs, guards, targets, ops and specials of
// other stages, constant addresses out of range. If there are none, of the paths (isa/verify_flow.h): joins
// outside their regions, code that no lane reaches or that runs off its end, registers that nothing has
// written, frames that are left. What it accepts, the machines run without a fault of control flow; memory
// and rays may still fault.
void verify(const Program& program, Diagnostics& diagnostics);

}  // namespace glint::isa
