// Fuses products into sums.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/contraction.h"

#include <vector>

#include "frontend/backend/slots.h"

namespace glint::frontend::ptx {
namespace {

class Contraction {
 public:
  Contraction(Draft& draft, const FreeArithmetic& free, VirtualProgram& program)
      : draft_(draft),
        free_(free),
        program_(program),
        definitions_(program.registers.size()),
        uses_(program.registers.size()) {
    for (const DraftBlock& block : draft.blocks) {
      if (block.condition != kNoRegister) ++uses_[block.condition];
      for (const VirtualInst& inst : block.code) {
        for_each_def(inst, [&](VirtualRegister r) { ++definitions_[r]; });
        for_each_use(inst, [&](VirtualRegister r) { ++uses_[r]; });
      }
    }
  }

  void run() {
    for (DraftBlock& block : draft_.blocks) {
      products_.clear();
      std::vector<VirtualInst> out;
      for (VirtualInst& inst : block.code) {
        if (!fuse(inst, out)) out.push_back(inst);
        const VirtualRegister to = result_of(inst);
        if (to != kNoRegister && free_.at(to).op == 'm' && reads_fixed(inst)) products_[to] = inst;
      }
      block.code = std::move(out);
    }
  }

 private:
  // Returns the register of a free result that is written once, or kNoRegister.
  VirtualRegister result_of(const VirtualInst& inst) const {
    if (!is_real(inst) || inst.operands.empty() || inst.operands[0].kind != VirtualOperand::Kind::Register)
      return kNoRegister;
    const VirtualRegister to = inst.operands[0].reg;
    if (!free_.contains(to) || definitions_[to] != 1 || is_guarded(inst)) return kNoRegister;
    return inst.operands.size() == 3 ? to : kNoRegister;
  }
  // Returns whether the operands still hold the same values later.
  bool reads_fixed(const VirtualInst& inst) const {
    for (size_t i = 1; i < inst.operands.size(); ++i)
      if (is_register(inst.operands[i]) && definitions_[inst.operands[i].reg] != 1) return false;
    return true;
  }

  const VirtualInst* product(const VirtualOperand& o, const std::string& suffix) const {
    if (!is_register(o) || uses_[o.reg] != 1) return nullptr;
    const auto found = products_.find(o.reg);
    return found != products_.end() && free_.at(o.reg).suffix == suffix ? &found->second : nullptr;
  }

  VirtualOperand negated(const VirtualOperand& value, const std::string& suffix, const VirtualInst& like,
                         std::vector<VirtualInst>& out) {
    const VirtualOperand to =
        VirtualOperand::of(program_.new_register(program_.registers[like.operands[0].reg]));
    const int op = isa::find_op("neg" + suffix);
    out.push_back(make_inst(uint16_t(op), {to, value}, like.line));
    return to;
  }

  bool fuse(const VirtualInst& inst, std::vector<VirtualInst>& out) {
    const VirtualRegister to = result_of(inst);
    if (to == kNoRegister || free_.at(to).op == 'm') return false;
    const std::string& suffix = free_.at(to).suffix;
    const int fma = isa::find_op("fma.rn" + suffix);
    const bool subtracts = free_.at(to).op == 's';
    if (fma < 0 || (subtracts && isa::find_op("neg" + suffix) < 0)) return false;
    const VirtualInst* left = product(inst.operands[1], suffix);
    const VirtualInst* right = left ? nullptr : product(inst.operands[2], suffix);
    if (!left && !right) return false;
    const VirtualInst& factor = left ? *left : *right;
    VirtualOperand a = factor.operands[1], other = inst.operands[left ? 2 : 1];
    if (subtracts) (left ? other : a) = negated(left ? other : a, suffix, inst, out);
    out.push_back(make_inst(uint16_t(fma), {inst.operands[0], a, factor.operands[2], other}, inst.line));
    return true;
  }

  Draft& draft_;
  const FreeArithmetic& free_;
  VirtualProgram& program_;
  std::vector<uint32_t> definitions_, uses_;
  std::map<VirtualRegister, VirtualInst> products_;  // products of the block so far
};

}  // namespace

void contract(Draft& draft, const FreeArithmetic& free, VirtualProgram& program) {
  Contraction(draft, free, program).run();
}

}  // namespace glint::frontend::ptx
