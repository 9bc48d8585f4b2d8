// Fuses products into sums.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/contraction.h"

#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "frontend/backend/def_use.h"

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
      count_sums(block);
      std::vector<VirtualInst> out;
      for (VirtualInst& inst : block.code) {
        if (!fuse(inst, out)) out.push_back(inst);
        for_each_def(inst, [&](VirtualRegister r) {
          if (definitions_[r] != 1) forget(r);
        });
        const VirtualRegister to = result_of(inst);
        if (to != kNoRegister && definitions_[to] == 1 && free_.at(to).op == 'm' && !reads(inst, to))
          products_[to] = inst;
      }
      block.code = std::move(out);
    }
  }

 private:
  // Counts by register the sums of the block that may take in a product: the left one if both sources are
  // products.
  void count_sums(const DraftBlock& block) {
    sums_.assign(definitions_.size(), 0);
    std::set<VirtualRegister> products;
    for (const VirtualInst& inst : block.code) {
      const VirtualRegister to = result_of(inst);
      if (to == kNoRegister) continue;
      if (free_.at(to).op == 'm') {
        products.insert(to);
        continue;
      }
      for (size_t k : {size_t{1}, size_t{2}})
        if (is_register(inst.operands[k]) && products.contains(inst.operands[k].reg)) {
          ++sums_[inst.operands[k].reg];
          break;
        }
    }
  }

  // Returns the register of a free result, or kNoRegister.
  VirtualRegister result_of(const VirtualInst& inst) const {
    if (!is_real(inst) || inst.operands.empty() || inst.operands[0].kind != VirtualOperand::Kind::Register)
      return kNoRegister;
    const VirtualRegister to = inst.operands[0].reg;
    if (!free_.contains(to) || is_guarded(inst)) return kNoRegister;
    const FreeResult& result = free_.at(to);
    const std::string_view name = row_of(inst).name;
    const bool is_it =
        result.op != kNotFree && name.front() == result.op && name.substr(3) == ".rn" + result.suffix;
    return is_it && inst.operands.size() == 3 ? to : kNoRegister;
  }
  // Drops the products whose factors are no longer what they were: `r` is written, and not for the only time.
  void forget(VirtualRegister r) {
    std::erase_if(products_,
                  [&](const auto& product) { return product.first == r || reads(product.second, r); });
  }

  const VirtualInst* product(const VirtualOperand& o, const std::string& suffix) const {
    if (!is_register(o) || uses_[o.reg] != sums_[o.reg]) return nullptr;
    const auto found = products_.find(o.reg);
    return found != products_.end() && free_.at(o.reg).suffix == suffix ? &found->second : nullptr;
  }

  // Returns the negative of a value: a constant, or a register that a further instruction writes.
  VirtualOperand negated(const VirtualOperand& value, const std::string& suffix, const VirtualInst& like,
                         std::vector<VirtualInst>& out) {
    const bool is_wide = suffix == ".f64";
    if (is_constant(value) && (is_wide || suffix == ".f32"))
      return VirtualOperand::value(value.constant ^ (uint64_t{1} << (is_wide ? 63 : 31)));
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
    VirtualOperand a = factor.operands[1], b = factor.operands[2], other = inst.operands[left ? 2 : 1];
    int op = fma;
    if (subtracts && left && !is_constant(other) && suffix == ".f32") {
      op = isa::find_op("fms.rn.f32");
    } else if (subtracts && right && !is_constant(a) && !is_constant(b) && suffix == ".f32") {
      op = isa::find_op("nfma.rn.f32");
    } else if (subtracts) {
      VirtualOperand& changed = left ? other : is_constant(b) ? b : a;
      changed = negated(changed, suffix, inst, out);
    }
    out.push_back(make_inst(uint16_t(op), {inst.operands[0], a, b, other}, inst.line));
    return true;
  }

  Draft& draft_;
  const FreeArithmetic& free_;
  VirtualProgram& program_;
  std::vector<uint32_t> definitions_, uses_;
  std::vector<uint32_t> sums_;                       // of the block, by product
  std::map<VirtualRegister, VirtualInst> products_;  // products of the block so far
};

}  // namespace

void contract(Draft& draft, const FreeArithmetic& free, VirtualProgram& program) {
  Contraction(draft, free, program).run();
}

}  // namespace glint::frontend::ptx
