// Says whether a value that one instruction read is still there for another.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/unchanged.h"

#include <functional>

namespace glint::frontend {

bool is_unchanged(const DefUse& registers, const VirtualBlock& block, const VirtualOperand& o,
                  const VirtualInst& from, const VirtualInst& to) {
  if (is_constant(o) || registers.definition(o)) return true;
  const VirtualInst *first = block.code.data(), *last = first + block.code.size();
  if (!is_register(o) || std::less<>()(&from, first) || !std::less<>()(&from, last) || &from >= &to)
    return false;
  bool changes = false;
  for (const VirtualInst* between = &from; between < &to; ++between)
    for_each_def(*between, [&](VirtualRegister r) { changes |= r == o.reg; });
  return !changes;
}

}  // namespace glint::frontend
