// Helps tests to write small virtual programs by hand.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "frontend/compile.h"
#include "frontend/virtual_program.h"

namespace glint::frontend::test {

using Operand = VirtualOperand;

class CodeBuilder {
 public:
  CodeBuilder() {
    program.name = "test";
    block("entry");
  }

  BlockId block(const std::string& name, std::vector<BlockId> successors = {}) {
    program.blocks.push_back({name, {}, std::move(successors)});
    return BlockId(program.blocks.size() - 1);
  }
  VirtualInst& add(const char* op, std::vector<Operand> operands = {}, int32_t imm = 0) {
    VirtualInst inst;
    inst.op = isa::op_index(op);
    inst.operands = std::move(operands);
    inst.imm = imm;
    program.blocks.back().code.push_back(inst);
    return program.blocks.back().code.back();
  }
  void marker(VirtualInst::Kind kind) {
    program.blocks.back().code.emplace_back();
    program.blocks.back().code.back().kind = kind;
  }
  // Returns a loaded value, which nothing can fold.
  Operand word(int32_t offset = 0) {
    const Operand r = Operand::of(program.new_register(RegisterClass::B32));
    add("ld.const.b32", {r, Operand::value(0)}, offset);
    return r;
  }
  Operand pair(int32_t offset = 0) {
    const Operand r = Operand::of(program.new_register(RegisterClass::B64));
    add("ld.const.b64", {r, Operand::value(0)}, offset);
    return r;
  }
  Operand fresh(RegisterClass c) { return Operand::of(program.new_register(c)); }
  isa::Program assembled(BackendOptions options = {}) const { return assemble(program, options); }

  VirtualProgram program;
};

inline std::vector<std::string> names_of(const isa::Program& program) {
  std::vector<std::string> out;
  for (const isa::Inst& inst : program.code) out.emplace_back(isa::op_table()[inst.op].name);
  return out;
}
inline size_t count_of(const isa::Program& program, const std::string& name) {
  size_t count = 0;
  for (const std::string& op : names_of(program)) count += op == name;
  return count;
}

}  // namespace glint::frontend::test
