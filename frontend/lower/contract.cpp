// Fuses products and sums into one op where the shader's author lets the compiler choose.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "frontend/lower/lowering.h"

namespace glint::frontend {
namespace {

std::string_view name_of(const VirtualInst& inst) {
  return inst.kind == VirtualInst::Kind::Real ? isa::op_table()[inst.op].name : std::string_view();
}

// Returns what follows the verb in an op's name, such as ".rn.f32" for "add.rn.f32"; empty for another op.
std::string_view suffix_after(std::string_view name, std::string_view verb) {
  if (!name.starts_with(verb)) return {};
  const std::string_view suffix = name.substr(verb.size());
  return suffix == ".rn.f16" || suffix == ".rn.f32" || suffix == ".rn.f64" ? suffix : std::string_view();
}

class Contraction {
 public:
  Contraction(VirtualProgram& program, const std::set<VirtualRegister>& free)
      : program_(program), free_(free), uses_(program.registers.size()) {
    for (const VirtualBlock& block : program.blocks)
      for (const VirtualInst& inst : block.code) {
        if (inst.guard != kNoRegister) ++uses_[inst.guard];
        for (const Operand& operand : inst.operands)
          if (operand.kind == Operand::Kind::Register) ++uses_[operand.reg];  // counts the definition, too
      }
  }

  void block(VirtualBlock& block) {
    products_.clear();
    std::vector<VirtualInst> code;
    for (VirtualInst& inst : block.code) {
      const std::string_view name = name_of(inst);
      const std::string_view sum = suffix_after(name, "add"), difference = suffix_after(name, "sub");
      if ((!sum.empty() || !difference.empty()) && free_.count(inst.operands[0].reg))
        fuse(inst, sum.empty() ? difference : sum, sum.empty(), code);
      if (!suffix_after(name, "mul").empty() && free_.count(inst.operands[0].reg))
        products_[inst.operands[0].reg] = inst;
      code.push_back(std::move(inst));
    }
    block.code = std::move(code);
  }

 private:
  // Choice: of two products the left one is fused, as NVIDIA's compiler does (frontend/ptx/contraction.h).
  void fuse(VirtualInst& inst, std::string_view suffix, bool is_difference, std::vector<VirtualInst>& code) {
    for (size_t side = 1; side <= 2; ++side) {
      const Operand product = inst.operands[side];
      const auto found =
          product.kind == Operand::Kind::Register ? products_.find(product.reg) : products_.end();
      if (found == products_.end() || uses_[product.reg] != 2 ||
          suffix_after(name_of(found->second), "mul") != suffix)
        continue;
      Operand a = found->second.operands[1], c = inst.operands[3 - side];
      if (is_difference) (side == 1 ? c : a) = negative(side == 1 ? c : a, suffix, inst, code);
      inst.op = isa::op_index("fma" + std::string(suffix));
      inst.operands = {inst.operands[0], a, found->second.operands[2], c};
      return;
    }
  }

  Operand negative(const Operand& x, std::string_view suffix, const VirtualInst& at,
                   std::vector<VirtualInst>& code) {
    const bool is_wide = suffix == ".rn.f64";
    VirtualInst inst;
    inst.op = isa::op_index("neg" + std::string(suffix.substr(3)));
    inst.line = at.line;
    inst.operands = {Operand::of(program_.new_register(is_wide ? RegisterClass::B64 : RegisterClass::B32)),
                     x};
    code.push_back(inst);
    return inst.operands[0];
  }

  VirtualProgram& program_;
  const std::set<VirtualRegister>& free_;
  std::vector<uint32_t> uses_;                       // number of uses, plus one for the definition
  std::map<VirtualRegister, VirtualInst> products_;  // products of the block so far
};

}  // namespace

void contract(VirtualProgram* program, const std::set<VirtualRegister>& free) {
  Contraction contraction(*program, free);
  for (VirtualBlock& block : program->blocks) contraction.block(block);
}

}  // namespace glint::frontend
