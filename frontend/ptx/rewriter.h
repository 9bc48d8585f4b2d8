// Replaces instructions by others while the counts of definitions and uses stay right.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "frontend/backend/def_use.h"
#include "frontend/backend/unchanged.h"

namespace glint::frontend::ptx {

// The base of passes that go through a program and change its instructions in place.
class Rewriter {
 public:
  explicit Rewriter(VirtualProgram& program) : program_(program), registers_(program) {}

 protected:
  // Returns the definition of an operand if its sources hold the same values at `user`.
  VirtualInst* source_of(const VirtualOperand& o, const VirtualInst& user) const {
    VirtualInst* source = registers_.definition(o);
    if (!source || !is_real(*source)) return nullptr;
    for (size_t k = 1; k < source->operands.size(); ++k)
      if (!is_unchanged(registers_, *block_, source->operands[k], *source, user)) return nullptr;
    return source;
  }
  // Does so for an operand that only `user` reads.
  VirtualInst* feeder(const VirtualOperand& o, const VirtualInst& user) const {
    return registers_.is_used_once(o) ? source_of(o, user) : nullptr;
  }
  static bool is_word(const VirtualOperand& o) { return is_register(o) || is_constant(o); }

  // Gives the instruction another op and other sources.
  void become(VirtualInst& inst, uint16_t op, std::vector<VirtualOperand> sources) {
    for_each_use(inst, [&](VirtualRegister r) { --registers_.uses[r]; });
    inst.op = op;
    inst.operands.resize(1);
    inst.operands.insert(inst.operands.end(), sources.begin(), sources.end());
    for_each_use(inst, [&](VirtualRegister r) { ++registers_.uses[r]; });
  }
  // As become(), where nothing but `inst` read the result of `source`. The counts then know that its sources
  // have one reader less, as if it were gone.
  void absorb(VirtualInst& inst, uint16_t op, std::vector<VirtualOperand> sources,
              const VirtualInst& source) {
    for_each_use(source, [&](VirtualRegister r) { --registers_.uses[r]; });
    become(inst, op, std::move(sources));
  }
  VirtualOperand new_value(RegisterClass c) {
    registers_.definitions.push_back(1);
    registers_.uses.push_back(0);
    registers_.last.push_back(nullptr);
    return VirtualOperand::of(program_.new_register(c));
  }

  VirtualProgram& program_;
  const Ops ops_;
  DefUse registers_;
  const VirtualBlock* block_ = nullptr;  // the block that the pass is in
};

}  // namespace glint::frontend::ptx
