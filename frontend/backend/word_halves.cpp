// Finds words that are halves of pairs, and who reads them.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/word_halves.h"

#include <cstddef>
#include <vector>

#include "frontend/backend/def_use.h"

namespace glint::frontend {
namespace {

class Halves {
 public:
  Halves(VirtualProgram& program, const Ops& ops)
      : program_(program), ops_(ops), registers_(program), halves_(program.registers.size()) {}

  void run() {
    for (VirtualBlock& block : program_.blocks)
      for (VirtualInst& inst : block.code) note(inst);
    for_each_reader([&](VirtualInst& inst, VirtualOperand& o, isa::OperandKind kind) {
      if (kind != isa::OperandKind::Src32 || ops_.is_move(inst.op))
        halves_[o.reg].kind = VirtualOperand::Kind::None;
    });
    // Words whose every reader can read a half.
    for_each_reader([&](VirtualInst&, VirtualOperand& o, isa::OperandKind) { o = halves_[o.reg]; });
    for (VirtualBlock& block : program_.blocks)
      std::erase_if(block.code, [&](const VirtualInst& inst) { return is_gone(inst); });
  }

 private:
  bool is_half(const VirtualOperand& o) const { return is_register(o) && is_register(halves_[o.reg]); }
  bool takes_high_word(const VirtualInst& inst) const {
    return inst.op == shr_low_ && is_constant(inst.operands[2]) && inst.operands[2].constant == 32;
  }

  // Notes what half of which pair the instruction takes out.
  void note(const VirtualInst& inst) {
    if (!is_real(inst) || is_guarded(inst)) return;
    const auto take = [&](size_t to, size_t from, bool is_high) {
      const VirtualOperand &word = inst.operands[to], &pair = inst.operands[from];
      if (registers_.definition(word) != &inst || !registers_.definition(pair)) return;
      halves_[word.reg] = VirtualOperand::of(pair.reg);
      halves_[word.reg].is_high = is_high;
    };
    if (inst.op == ops_.low_word) take(0, 1, false);
    if (takes_high_word(inst)) take(0, 1, true);
    if (inst.op == ops_.unpack) take(0, 2, false), take(1, 2, true);
  }
  bool is_gone(const VirtualInst& inst) const {
    if (!is_real(inst) || is_guarded(inst)) return false;
    if (inst.op == ops_.unpack) return is_half(inst.operands[0]) && is_half(inst.operands[1]);
    return (inst.op == ops_.low_word || takes_high_word(inst)) && is_half(inst.operands[0]);
  }

  // Calls visit(instruction, operand, kind) for each source that is a half.
  template <class Visit>
  void for_each_reader(Visit&& visit) {
    for (VirtualBlock& block : program_.blocks)
      for (VirtualInst& inst : block.code)
        if (is_real(inst))
          for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
            VirtualOperand& o = inst.operands[slot];
            if (!isa::is_destination(kind) && is_half(o)) visit(inst, o, kind);
          });
  }

  VirtualProgram& program_;
  const Ops& ops_;
  const DefUse registers_;
  std::vector<VirtualOperand> halves_;  // by word: the pair's half, if all readers can read it
  const uint16_t shr_low_ = isa::op_index("shr.low.u64");
};

}  // namespace

void read_halves(VirtualProgram& program, const Ops& ops) {
  Halves(program, ops).run();
}

}  // namespace glint::frontend
