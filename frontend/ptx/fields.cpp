// Finds insertions at constant places.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/fields.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "frontend/backend/slots.h"

namespace glint::frontend::ptx {

void expand_fields(Draft& draft, VirtualProgram& program) {
  const Ops ops;
  const uint16_t bfi = isa::op_index("bfi.b32"), lop3 = isa::op_index("lop3.b32");
  constexpr uint64_t kFirstWhereThird = 0xe4;  // truth table of c ? a : b
  for (DraftBlock& block : draft.blocks) {
    std::vector<VirtualInst> code;
    for (VirtualInst& inst : block.code) {
      const bool is_constant_field = is_real(inst) && inst.op == bfi && !is_guarded(inst) &&
                                     is_constant(inst.operands[3]) && is_constant(inst.operands[4]);
      const uint64_t at = is_constant_field ? uint32_t(inst.operands[3].constant) : 0,
                     size = is_constant_field ? uint32_t(inst.operands[4].constant) : 0;
      if (size == 0 || at + size > 32) {
        code.push_back(std::move(inst));
        continue;
      }
      const uint64_t mask = ((uint64_t{1} << size) - 1) << at;
      VirtualOperand field = inst.operands[1];
      if (at != 0) {
        const VirtualOperand shifted = VirtualOperand::of(program.new_register(RegisterClass::B32));
        code.push_back(make_inst(ops.shl_b32, {shifted, field, VirtualOperand::value(at)}, inst.line));
        field = shifted;
      }
      code.push_back(make_inst(lop3,
                               {inst.operands[0], field, inst.operands[2], VirtualOperand::value(mask),
                                VirtualOperand::value(kFirstWhereThird)},
                               inst.line));
    }
    block.code = std::move(code);
  }
}

}  // namespace glint::frontend::ptx
