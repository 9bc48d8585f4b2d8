// Finds comparisons with 0 and the logic that they test.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/logic_tests.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "frontend/ptx/rewriter.h"

namespace glint::frontend::ptx {
namespace {

class LogicTests : Rewriter {
 public:
  explicit LogicTests(VirtualProgram& program) : Rewriter(program) {}

  void run() {
    for (VirtualBlock& block : program_.blocks) {
      block_ = &block;
      for (VirtualInst& inst : block.code)
        if (is_real(inst) && !is_guarded(inst)) test(inst);
    }
  }

 private:
  // Returns the sources of lop3 for an instruction that it can do, or nothing.
  std::vector<VirtualOperand> logic_of(const VirtualInst& inst) const {
    const uint64_t table = inst.op == and_ ? 0xc0 : inst.op == or_ ? 0xfc : inst.op == xor_ ? 0x3c : 0;
    if (inst.op == lop3_ && is_constant(inst.operands[4]))
      return {inst.operands.begin() + 1, inst.operands.end()};
    if (table == 0) return {};
    return {inst.operands[1], inst.operands[2], VirtualOperand::value(0), VirtualOperand::value(table)};
  }

  void test(VirtualInst& inst) {
    const bool is_ne = inst.op == setp_ne_[0] || inst.op == setp_ne_[1] || inst.op == setp_ne_[2];
    if (!is_ne && inst.op != setp_eq_[0] && inst.op != setp_eq_[1] && inst.op != setp_eq_[2]) return;
    const VirtualOperand value = inst.operands[1], zero = inst.operands[2];
    if (!is_constant(zero) || uint32_t(zero.constant) != 0) return;
    VirtualInst* source = source_of(value, inst);
    if (!source || is_guarded(*source)) return;
    if (source->op == lop3_both_) {
      become(inst, is_ne ? ops_.mov_pred : ops_.not_pred, {source->operands[1]});
      return;
    }
    const std::vector<VirtualOperand> sources = logic_of(*source);
    if (sources.empty()) return;
    if (registers_.is_used_once(value)) {
      absorb(inst, is_ne ? lop3_ne_ : lop3_eq_, sources, *source);
    } else if (is_in_block(*source) && registers_.definition(inst.operands[0])) {
      const VirtualOperand found = new_value(RegisterClass::Predicate);
      become(*source, lop3_both_, sources);
      source->operands.insert(source->operands.begin() + 1, found);
      registers_.last[found.reg] = source;
      become(inst, is_ne ? ops_.mov_pred : ops_.not_pred, {found});
    }
  }
  bool is_in_block(const VirtualInst& inst) const {
    const VirtualInst *first = block_->code.data(), *last = first + block_->code.size();
    return &inst >= first && &inst < last;
  }

  const uint16_t and_ = isa::op_index("and.b32"), or_ = isa::op_index("or.b32"),
                 xor_ = isa::op_index("xor.b32"), lop3_ = isa::op_index("lop3.b32");
  const uint16_t lop3_ne_ = isa::op_index("lop3.ne.b32"), lop3_eq_ = isa::op_index("lop3.eq.b32"),
                 lop3_both_ = isa::op_index("lop3.both.b32");
  const uint16_t setp_ne_[3] = {isa::op_index("setp.ne.s32"), isa::op_index("setp.ne.u32"),
                                isa::op_index("setp.ne.b32")};
  const uint16_t setp_eq_[3] = {isa::op_index("setp.eq.s32"), isa::op_index("setp.eq.u32"),
                                isa::op_index("setp.eq.b32")};
};

}  // namespace

void test_logic(VirtualProgram& program) {
  LogicTests(program).run();
}

}  // namespace glint::frontend::ptx
