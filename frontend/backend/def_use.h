// Tells where a program's registers are written and read, for passes over values that are written once.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "frontend/backend/slots.h"

namespace glint::frontend {

// Returns true when the instruction reads the register, also as its guard.
inline bool reads(const VirtualInst& inst, VirtualRegister r) {
  bool found = false;
  for_each_use(inst, [&](VirtualRegister used) { found |= used == r; });
  return found;
}

// Holds counts by register. They stay valid while instructions are changed in place; a pass that changes
// operands updates the counts.
struct DefUse {
  explicit DefUse(VirtualProgram& program)
      : definitions(program.registers.size()),
        uses(program.registers.size()),
        last(program.registers.size()) {
    for (VirtualBlock& block : program.blocks)
      for (VirtualInst& inst : block.code) {
        for_each_def(inst, [&](VirtualRegister r) {
          ++definitions[r];
          last[r] = is_guarded(inst) ? nullptr : &inst;
        });
        for_each_use(inst, [&](VirtualRegister r) { ++uses[r]; });
      }
  }

  // Returns the one definition of a register. It returns nothing for a register with several definitions or a
  // guarded one, and for an operand that is not a register.
  VirtualInst* definition(const VirtualOperand& o) const {
    return is_register(o) && definitions[o.reg] == 1 ? last[o.reg] : nullptr;
  }
  bool is_used_once(const VirtualOperand& o) const { return is_register(o) && uses[o.reg] == 1; }

  std::vector<uint32_t> definitions, uses;
  std::vector<VirtualInst*> last;  // the definition; null: guarded, or none
};

}  // namespace glint::frontend
