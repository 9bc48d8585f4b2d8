// Encloses each rq.proceed in a call region.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/query_calls.h"

#include <utility>
#include <vector>

#include "isa/op_row.h"

namespace glint::frontend {

void make_queries_calls(VirtualProgram& program) {
  for (VirtualBlock& block : program.blocks) {
    std::vector<VirtualInst> code;
    for (VirtualInst& inst : block.code) {
      const bool calls = inst.kind == VirtualInst::Kind::Real &&
                         isa::op_table()[inst.op].effect == isa::Effect::QueryProceed;
      VirtualInst marker;
      marker.line = inst.line;
      marker.kind = VirtualInst::Kind::SaveLive;
      if (calls) code.push_back(marker);
      code.push_back(std::move(inst));
      marker.kind = VirtualInst::Kind::RestoreLive;
      if (calls) code.push_back(marker);
    }
    block.code = std::move(code);
  }
}

}  // namespace glint::frontend
