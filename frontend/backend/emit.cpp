// Encoding, branch clean-up and label resolution.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/emit.h"

#include <algorithm>
#include <set>

#include "base/check.h"

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

// An encoded instruction whose label is still a block.
struct Coded {
  isa::Inst inst;
  isa::Line line;
  BlockId target = kNoBlock;
};
using Code = std::vector<std::vector<Coded>>;  // one a block, in layout order

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
  // What the allocation has made useless: moves onto themselves, in all their spellings.
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
    GLINT_CHECK(slots == inst.operands.size(), "'{}': {} takes {} operands, it has {}", program_.name, row.name, slots,
                inst.operands.size());
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
        return isa::Slot(isa::kRegisterBank + slot);
      }
      case VirtualOperand::Kind::Constant:
        return kind == isa::OperandKind::Src64 ? constants_.pair(operand.constant) : constants_.word(uint32_t(operand.constant));
      case VirtualOperand::Kind::Special:
        out_.specials_used |= uint64_t{1} << int(operand.special);
        return isa::Slot(isa::kSpecialBank + isa::Slot(operand.special));
      case VirtualOperand::Kind::StackPointer: return isa::kStackPointer;
      case VirtualOperand::Kind::None: break;
    }
    GLINT_PANIC("'{}': {} has an empty operand", program_.name, row.name);
  }

  const VirtualProgram& program_;
  const Allocation& allocation_;
  const Ops& ops_;
  isa::Program& out_;
  ConstantTable constants_;
};

// Removes what control flow does not need.
class BranchCleaner {
 public:
  BranchCleaner(Code& code, const Ops& ops) : code_(code), ops_(ops) {}

  void run() {
    for (bool changed = true; changed;) {
      thread();
      changed = drop_unreachable();
      for (size_t b = 0; b < code_.size(); ++b) changed |= tidy_end(b);
    }
  }

 private:
  static bool is_guarded(const Coded& c) { return c.inst.guard != isa::kNoGuard; }
  bool is_branch(const Coded& c) const { return c.inst.op == ops_.bra; }
  bool leaves(const Coded& c) const {
    const isa::Effect effect = isa::op_table()[c.inst.op].effect;
    return !is_guarded(c) && (effect == isa::Effect::Branch || effect == isa::Effect::Exit ||
                              effect == isa::Effect::Return || effect == isa::Effect::Ignore ||
                              effect == isa::Effect::Terminate);
  }
  size_t first_code(size_t block) const {
    while (block < code_.size() && code_[block].empty()) ++block;
    return block;
  }

  // A branch to an unguarded branch goes to that one's target. An endless ring of branches stays as it is.
  void thread() {
    for (std::vector<Coded>& block : code_)
      for (Coded& c : block) {
        if (!is_branch(c)) continue;
        for (size_t hops = 0; hops < code_.size(); ++hops) {
          const size_t at = first_code(c.target);
          if (at == code_.size() || !is_branch(code_[at].front()) || is_guarded(code_[at].front())) break;
          c.target = code_[at].front().target;
        }
      }
  }

  bool drop_unreachable() {
    std::vector<bool> seen(code_.size());
    std::vector<size_t> work{0};
    bool changed = false;
    while (!work.empty()) {
      const size_t b = work.back();
      work.pop_back();
      if (b >= code_.size() || seen[b]) continue;
      seen[b] = true;
      std::vector<Coded>& block = code_[b];
      const auto last = std::find_if(block.begin(), block.end(), [&](const Coded& c) { return leaves(c); });
      if (last != block.end() && last + 1 != block.end()) {
        block.erase(last + 1, block.end());
        changed = true;
      }
      for (const Coded& c : block)
        if (c.target != kNoBlock) work.push_back(c.target);
      if (block.empty() || !leaves(block.back())) work.push_back(b + 1);
    }
    for (size_t b = 0; b < code_.size(); ++b) {
      if (seen[b] || code_[b].empty()) continue;
      code_[b].clear();
      changed = true;
    }
    return changed;
  }

  bool tidy_end(size_t b) {
    std::vector<Coded>& block = code_[b];
    const size_t next = first_code(b + 1);
    const auto goes_next = [&](const Coded& c) { return is_branch(c) && first_code(c.target) == next; };
    if (!block.empty() && goes_next(block.back())) {
      block.pop_back();
      return true;
    }
    if (block.size() < 2) return false;
    Coded& choice = block[block.size() - 2];
    if (!is_branch(choice) || !is_guarded(choice) || !is_branch(block.back()) || is_guarded(block.back())) return false;
    if (goes_next(choice)) {
      choice.inst.guard ^= isa::kGuardNegate;
      choice.target = block.back().target;
    } else if (first_code(choice.target) != first_code(block.back().target)) {
      return false;
    } else {
      std::swap(choice, block.back());  // both ways lead to the same place: the guarded one goes
    }
    block.pop_back();
    return true;
  }

  Code& code_;
  const Ops& ops_;
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
  out.local_bytes = program.local_bytes;
  out.payload_bytes = program.payload_bytes;
  out.attribute_bytes = program.attribute_bytes;
  out.local_size = program.local_size;
  Code code = Encoder(program, allocation, ops, out).run();
  BranchCleaner(code, ops).run();
  lay_out(program, code, out);
  return out;
}

}  // namespace glint::frontend
