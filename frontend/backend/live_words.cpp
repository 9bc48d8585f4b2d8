// Counts the live registers at each instruction that may move threads.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/live_words.h"

#include <bitset>

#include "frontend/backend/liveness.h"
#include "isa/op_row.h"

namespace glint::frontend {
namespace {

bool counts_live_words(const VirtualInst& inst) {
  return inst.kind == VirtualInst::Kind::Real && isa::op_table()[inst.op].effect == isa::Effect::Reorder &&
         !inst.operands.empty();
}

// Predicates are single bits and do not count.
uint32_t words_of(const RegisterSet& live, const VirtualProgram& program, const Allocation& allocation) {
  std::bitset<isa::kMaxRegisters + 1> used;
  used.set(isa::kStackPointer);
  live.for_each([&](VirtualRegister r) {
    if (program.registers[r] == RegisterClass::Predicate) return;
    used.set(allocation.slot[r]);
    if (program.registers[r] == RegisterClass::B64) used.set(allocation.slot[r] + 1u);
  });
  return uint32_t(used.count());
}

}  // namespace

void count_live_words(VirtualProgram& program, const Allocation& allocation) {
  const Liveness liveness = find_liveness(program);
  for (BlockId b = 0; b < program.blocks.size(); ++b) {
    LiveWalk walk(liveness.out[b]);
    std::vector<VirtualInst>& code = program.blocks[b].code;
    for (size_t i = code.size(); i-- > 0;) {
      if (counts_live_words(code[i]))
        code[i].operands.back() = VirtualOperand::value(words_of(walk.live(), program, allocation));
      walk.step(code[i]);
    }
  }
}

}  // namespace glint::frontend
