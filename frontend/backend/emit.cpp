// Encodes instructions, lays out blocks and resolves labels.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/emit.h"

#include <algorithm>
#include <cstdint>
#include <set>

#include "base/check.h"
#include "frontend/backend/branches.h"

namespace glint::frontend {

isa::Slot ConstantTable::word(uint32_t value) {
  const auto [at, is_new] = words_.try_emplace(value, isa::Slot(isa::kConstantBank + rows_.size()));
  if (is_new) rows_.push_back(value);
  return at->second;
}

isa::Slot ConstantTable::pair(uint64_t value) {
  const auto [at, is_new] = pairs_.try_emplace(value, isa::Slot(isa::kConstantBank + rows_.size()));
  if (is_new) {
    for (uint32_t half : {uint32_t(value), uint32_t(value >> 32)}) {
      words_.try_emplace(half, isa::Slot(isa::kConstantBank + rows_.size()));
      rows_.push_back(half);
    }
  }
  return at->second;
}

namespace {

class Encoder {
 public:
  Encoder(const VirtualProgram& program, const Allocation& allocation, const Ops& ops, isa::Program& out)
      : program_(program), allocation_(allocation), ops_(ops), out_(out) {}

  Code run() {
    Code code(program_.blocks.size());
    for (size_t b = 0; b < code.size(); ++b)
      for (const VirtualInst& inst : program_.blocks[b].code)
        if (!does_nothing(inst)) code[b].push_back(encode(inst));
    out_.constants = constants_.take();
    return code;
  }

 private:
  // Returns true for instructions that the allocation has made useless: moves of a register onto itself, in
  // all their spellings.
  bool does_nothing(const VirtualInst& inst) const {
    const auto at = [&](size_t slot) {
      const VirtualOperand& o = inst.operands[slot];
      return is_register(o) ? int(allocation_.slot[o.reg]) : -1;
    };
    if (ops_.is_move(inst.op) || inst.op == ops_.low_word) return at(0) == at(1);
    if (inst.op == ops_.pack) return at(1) == at(0) && at(2) == at(0) + 1;
    if (inst.op == ops_.unpack) return at(0) == at(2) && at(1) == at(2) + 1;
    return false;
  }

  Coded encode(const VirtualInst& inst) {
    GLINT_CHECK(is_real(inst), "'{}': SaveLive and RestoreLive must be expanded first", program_.name);
    const isa::OpRow& row = row_of(inst);
    Coded out{{}, inst.line, inst.target};
    out.inst.op = inst.op;
    out.inst.imm = inst.imm;
    if (is_guarded(inst))
      out.inst.guard = uint8_t(allocation_.slot[inst.guard] | (inst.guard_negate ? isa::kGuardNegate : 0));
    size_t slots = 0;
    for_each_slot(row, [&](size_t slot, isa::OperandKind kind) {
      GLINT_CHECK(slot < inst.operands.size(), "'{}': {} lacks operands, it has {}", program_.name, row.name,
                  inst.operands.size());
      out.inst.operand[slot] = slot_of(inst.operands[slot], kind, row);
      slots = slot + 1;
    });
    GLINT_CHECK(slots == inst.operands.size(), "'{}': {} takes {} operands, it has {}", program_.name,
                row.name, slots, inst.operands.size());
    return out;
  }

  isa::Slot slot_of(const VirtualOperand& operand, isa::OperandKind kind, const isa::OpRow& row) {
    switch (operand.kind) {
      case VirtualOperand::Kind::Register: {
        const RegisterClass c = program_.registers[operand.reg];
        const isa::Slot slot = allocation_.slot[operand.reg];
        if (c == RegisterClass::Predicate) return slot;
        const uint32_t registers = slot + (c == RegisterClass::B64 ? 2u : 1u);
        out_.num_registers = std::max(out_.num_registers, registers);
        return isa::Slot(isa::kRegisterBank + slot + (operand.is_high ? 1 : 0));
      }
      case VirtualOperand::Kind::Constant:
        return kind == isa::OperandKind::Src64 || kind == isa::OperandKind::Address64
                   ? constants_.pair(operand.constant)
                   : constants_.word(uint32_t(operand.constant));
      case VirtualOperand::Kind::Special:
        return isa::Slot(isa::kSpecialBank + isa::Slot(operand.special));
      case VirtualOperand::Kind::StackPointer:
      case VirtualOperand::Kind::CalleeFrame:
        return isa::kStackPointer;
      case VirtualOperand::Kind::None:
        break;
    }
    GLINT_PANIC("'{}': {} has an empty operand", program_.name, row.name);
  }

  const VirtualProgram& program_;
  const Allocation& allocation_;
  const Ops& ops_;
  isa::Program& out_;
  ConstantTable constants_;
};

std::string label_text(const std::string& name, size_t block, std::set<std::string>& used) {
  std::string text = name.empty() ? "L" + std::to_string(block) : name;
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') c = '_';
  if (std::isdigit(static_cast<unsigned char>(text.front()))) text.insert(text.begin(), 'L');
  if (!used.insert(text).second) {
    text += "_" + std::to_string(block);
    while (!used.insert(text).second) text += "_";
  }
  return text;
}

void lay_out(const VirtualProgram& program, const Code& code, isa::Program& out) {
  std::vector<uint32_t> start(code.size() + 1);
  for (size_t b = 0; b < code.size(); ++b) start[b + 1] = start[b] + uint32_t(code[b].size());
  std::set<std::string> used;
  std::map<uint32_t, BlockId> labelled;
  for (const std::vector<Coded>& block : code)
    for (const Coded& c : block) {
      out.code.push_back(c.inst);
      out.lines.push_back(c.line);
      if (c.target == kNoBlock) continue;
      const uint32_t at = start[c.target];
      GLINT_CHECK(at < start.back(), "'{}': a branch leads behind the last instruction", program.name);
      out.code.back().imm = int32_t(at);
      labelled.try_emplace(at, c.target);
    }
  for (const auto& [at, block] : labelled)
    out.labels.emplace_back(at, label_text(program.blocks[block].name, block, used));
}

}  // namespace

isa::Program emit(const VirtualProgram& program, const Allocation& allocation, const Ops& ops) {
  isa::Program out;
  out.name = program.name;
  out.stage = program.stage;
  out.files = program.files;
  out.scopes = program.scopes;
  out.spirv = program.spirv;
  out.local_bytes = program.local_bytes;
  out.function = program.function;
  out.payload_bytes = program.payload_bytes;
  out.attribute_bytes = program.attribute_bytes;
  out.local_size = program.local_size;
  out.shared_bytes = program.shared_bytes;
  out.messages = program.messages;
  Code code = Encoder(program, allocation, ops, out).run();
  clean_branches(code, ops);
  lay_out(program, code, out);
  return out;
}

}  // namespace glint::frontend
