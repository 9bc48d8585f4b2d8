// Finds what an instruction does to memory.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/memory_use.h"

namespace glint::frontend {

MemoryUse memory_use(const VirtualInst& inst) {
  const isa::OpRow& row = row_of(inst);
  MemoryUse use;
  const isa::EffectRow& effect = isa::effect_row(row.effect);
  if (effect.family == isa::EffectFamily::Image) {
    // Choice: images and buffers may share memory, so texture and surface ops are ordered like global
    // accesses.
    use = {true, effect.writes_memory, false, isa::Space::Global, 0, 0};
  } else if (effect.family == isa::EffectFamily::Memory) {
    use = {true,     effect.writes_memory,
           false,    row.memory.space,
           inst.imm, int64_t{inst.imm} + row.memory.bytes * row.memory.count};
    for (const VirtualOperand& o : inst.operands)
      use.in_frame |= o.kind == VirtualOperand::Kind::StackPointer;
  }
  return use;
}

bool must_stay_in_order(const MemoryUse& a, const MemoryUse& b) {
  if (!a.any || !b.any || (!a.writes && !b.writes)) return false;
  // A generic address may lie in any space.
  const bool is_generic = a.space == isa::Space::Generic || b.space == isa::Space::Generic;
  if (a.space != b.space && !is_generic) return false;
  if (a.in_frame && b.in_frame) return a.begin < b.end && b.begin < a.end;
  return true;
}

}  // namespace glint::frontend
