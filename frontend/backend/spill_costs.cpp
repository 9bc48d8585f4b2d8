// Counts accesses by the weights of their blocks, and the words that calls save.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/spill_costs.h"

#include "frontend/backend/slots.h"

namespace glint::frontend {

SpillCosts::SpillCosts(const VirtualProgram& program, const Liveness& liveness,
                       const std::vector<float>& weights)
    : cost_(program.registers.size()) {
  for (BlockId b = 0; b < program.blocks.size(); ++b)
    for (const VirtualInst& inst : program.blocks[b].code) {
      const auto count = [&](VirtualRegister r) { cost_[r] += weights[b]; };
      for_each_def(inst, count);
      for_each_use(inst, count);
    }
  // One instruction saves or restores four registers.
  constexpr float kInstructionsASavedWord = 2.0f / 4.0f;
  for (const CallRegion& region : find_call_regions(program, liveness))
    region.live.for_each([&](VirtualRegister r) {
      const float words = program.registers[r] == RegisterClass::B64 ? 2.0f : 1.0f;
      cost_[r] -= words * kInstructionsASavedWord * weights[region.save.block];
    });
}

void SpillCosts::merge(const InterferenceGraph& graph, const std::vector<bool>& unspillable) {
  for (VirtualRegister r = 0; r < cost_.size(); ++r) {
    if (unspillable[r]) cost_[r] = kNeverSpill;
    if (graph.has(r) && graph.representative(r) != r) cost_[graph.representative(r)] += cost_[r];
  }
}

}  // namespace glint::frontend
