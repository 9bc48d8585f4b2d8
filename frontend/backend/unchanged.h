// Says whether a value that one instruction read is still there for another.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/backend/def_use.h"

namespace glint::frontend {

// Returns true when the operand has the same value at `to` as at `from`. It does when it is a constant, when
// it is written once, or when both instructions are in `block` and nothing between them writes it.
bool is_unchanged(const DefUse& registers, const VirtualBlock& block, const VirtualOperand& o,
                  const VirtualInst& from, const VirtualInst& to);

}  // namespace glint::frontend
