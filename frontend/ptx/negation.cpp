// Finds negations and what reads them.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/negation.h"

#include <cstddef>

#include "frontend/ptx/rewriter.h"

namespace glint::frontend::ptx {
namespace {

class Negations : Rewriter {
 public:
  explicit Negations(VirtualProgram& program) : Rewriter(program) {}

  void run() {
    for (VirtualBlock& block : program_.blocks) {
      block_ = &block;
      for (VirtualInst& inst : block.code)
        if (is_real(inst) && !is_guarded(inst)) fold(inst);
    }
  }

 private:
  // Returns the negation that computes the operand.
  const VirtualInst* negation(const VirtualOperand& o, const VirtualInst& user) const {
    const VirtualInst* source = source_of(o, user);
    return source && !is_guarded(*source) && source->op == neg_ && is_register(source->operands[1]) ? source
                                                                                                    : nullptr;
  }

  void fold(VirtualInst& inst) {
    if (inst.op == neg_) {
      const VirtualInst* product = feeder(inst.operands[1], inst);
      if (product && !is_guarded(*product) && product->op == mul_)
        absorb(inst, nmul_, {product->operands[1], product->operands[2]}, *product);
      return;
    }
    if (inst.op == fma_) return fold_into_fma(inst);
    if (inst.op != mul_ && inst.op != add_ && inst.op != sub_) return;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualInst* const source = negation(inst.operands[k], inst);
      if (!source || (inst.op == sub_ && k == 1)) continue;
      const VirtualOperand a = source->operands[1], other = inst.operands[3 - k];
      if (inst.op == mul_)
        become(inst, nmul_, {a, other});
      else if (inst.op == add_)
        become(inst, sub_, {other, a});
      else
        become(inst, add_, {other, a});
      return;
    }
  }
  void fold_into_fma(VirtualInst& inst) {
    const VirtualOperand a = inst.operands[1], b = inst.operands[2], c = inst.operands[3];
    if (const VirtualInst* source = negation(a, inst))
      become(inst, nfma_, {source->operands[1], b, c});
    else if (const VirtualInst* other = negation(b, inst))
      become(inst, nfma_, {other->operands[1], a, c});
    else if (const VirtualInst* addend = negation(c, inst))
      become(inst, fms_, {a, b, addend->operands[1]});
  }

  const uint16_t neg_ = isa::op_index("neg.f32"), mul_ = isa::op_index("mul.rn.f32"),
                 add_ = isa::op_index("add.rn.f32"), sub_ = isa::op_index("sub.rn.f32"),
                 fma_ = isa::op_index("fma.rn.f32");
  const uint16_t nmul_ = isa::op_index("nmul.rn.f32"), nfma_ = isa::op_index("nfma.rn.f32"),
                 fms_ = isa::op_index("fms.rn.f32");
};

}  // namespace

void fold_negations(VirtualProgram& program) {
  Negations(program).run();
}

}  // namespace glint::frontend::ptx
