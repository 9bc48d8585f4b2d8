// Checks that a machine can run a program: what the compiler or an assembler file must have got right.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "base/diagnostics.h"
#include "isa/program.h"

namespace glint::isa {

// Reports every mistake, each with instruction index and, if known, source line: unknown ops, operands of
// the wrong bank or out of range, odd pairs, guards, targets, ssy without join, code that runs off its end.
void verify(const Program& program, Diagnostics& diagnostics);

}  // namespace glint::isa
