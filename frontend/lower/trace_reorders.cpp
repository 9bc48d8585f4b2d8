// Puts an rt.reorder before each call of hit shaders.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/trace_reorders.h"

#include <utility>
#include <vector>

#include "isa/op_row.h"

namespace glint::frontend {

void reorder_before_hit_shaders(VirtualProgram& program) {
  const uint16_t op = isa::op_index("rt.reorder");
  for (VirtualBlock& block : program.blocks) {
    std::vector<VirtualInst> code;
    for (VirtualInst& inst : block.code) {
      if (inst.kind == VirtualInst::Kind::Real && isa::op_table()[inst.op].effect == isa::Effect::CallHit) {
        VirtualInst reorder;
        reorder.op = op;
        reorder.line = inst.line;
        code.push_back(std::move(reorder));
      }
      code.push_back(std::move(inst));
    }
    block.code = std::move(code);
  }
}

}  // namespace glint::frontend
