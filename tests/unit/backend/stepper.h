// Steps virtual and assembled programs for one lane with the op table's own handlers, and records what they do to
// the world: the measure of whether assembling has kept a program's meaning.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/check.h"
#include "frontend/virtual_program.h"

namespace glint::frontend::test {

// What left the lane, in order: "st.global 100 4 2a", "call.sbt.hit", "rt.trace ...".
using Log = std::vector<std::string>;

// Bytes by address; a byte never written reads as a hash of its address.
class Bytes {
 public:
  uint64_t load(uint64_t address, int bytes) const {
    uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) {
      const auto at = bytes_.find(address + uint64_t(i));
      const uint64_t byte = at != bytes_.end() ? at->second : ((address + uint64_t(i)) * 0x9e3779b97f4a7c15u) >> 56;
      value |= byte << (8 * i);
    }
    return value;
  }
  void store(uint64_t address, int bytes, uint64_t value) {
    for (int i = 0; i < bytes; ++i) bytes_[address + uint64_t(i)] = uint8_t(value >> (8 * i));
  }

 private:
  std::map<uint64_t, uint8_t> bytes_;
};

// The machine around one lane.
class Lane {
 public:
  static constexpr int kLane = 5;               // any will do; the others must stay out of it
  static constexpr size_t kMaxSteps = 200'000;  // a program that runs longer is stuck

  explicit Lane(size_t registers, size_t constants)
      : registers_(registers * kLanes + 16), constants_(constants * kLanes + 16), specials_(isa::kNumSpecials * kLanes + 16) {
    warp_ = std::make_unique<isa::Warp>();
    warp_->bank = {aligned(registers_), aligned(constants_), aligned(specials_)};
    warp_->exec = LaneMask{1} << kLane;
    for (int s = 0; s < isa::kNumSpecials; ++s) warp_->bank[2][s * kLanes + kLane] = 0x1000u + 77u * uint32_t(s);
  }

  Log log;
  Bytes global, local;

 protected:
  uint32_t& reg(isa::Slot slot) { return warp_->bank[slot >> isa::kBankShift][(slot & isa::kSlotIndexMask) * kLanes + kLane]; }
  bool predicate(size_t p) const { return (warp_->predicate[p] >> kLane) & 1; }
  void set_predicate(size_t p, bool value) {
    warp_->predicate[p] = (warp_->predicate[p] & ~(LaneMask{1} << kLane)) | LaneMask{value} << kLane;
  }
  uint64_t read(isa::Slot slot, bool is_pair) {
    return reg(slot) | (is_pair ? uint64_t{reg(isa::Slot(slot + 1))} << 32 : 0);
  }

  // Runs the handler and what the op does beyond the registers, control flow apart.
  void perform(const isa::Inst& inst) {
    const isa::OpRow& row = isa::op_table()[inst.op];
    row.run(*warp_, inst);
    if (row.effect == isa::Effect::Load || row.effect == isa::Effect::Store) access(inst, row);
    if (row.effect == isa::Effect::Trace || row.effect == isa::Effect::Resume) {
      if (row.effect == isa::Effect::Trace) candidates_ = 2;
      std::string text(row.name);
      if (row.effect == isa::Effect::Trace)
        for (int k = 1; k <= 16; ++k) text += fmt::format(" {:x}", read(inst.operand[size_t(k)], k == 1));
      log.push_back(text);
      set_predicate(inst.operand[0], candidates_-- > 0);
    }
  }

  std::unique_ptr<isa::Warp> warp_;
  size_t steps_ = 0;

 private:
  static uint32_t* aligned(std::vector<uint32_t>& words) {
    void* at = words.data();
    size_t space = words.size() * 4;
    return static_cast<uint32_t*>(std::align(64, 64, at, space));
  }

  void access(const isa::Inst& inst, const isa::OpRow& row) {
    Bytes& memory = row.memory.space == isa::Space::Local ? local : global;
    const bool is_store = row.effect == isa::Effect::Store;
    const uint64_t address = warp_->access.address[kLane];
    size_t slot = 0, part = 0;
    for (isa::OperandKind kind : row.operands.view()) {
      const bool is_address = kind == isa::OperandKind::Address32 || kind == isa::OperandKind::Address64;
      for (int i = 0; i < isa::slots_of(kind); ++i, ++slot) {
        if (is_address) continue;
        move_part(memory, row, address + part++ * row.memory.bytes, inst.operand[slot], is_store);
      }
    }
  }

  void move_part(Bytes& memory, const isa::OpRow& row, uint64_t address, isa::Slot slot, bool is_store) {
    const int bytes = row.memory.bytes;
    if (is_store) {
      const uint64_t value = read(slot, bytes == 8) & (bytes == 8 ? ~uint64_t{0} : (uint64_t{1} << (8 * bytes)) - 1);
      memory.store(address, bytes, value);
      if (row.memory.space == isa::Space::Global) log.push_back(fmt::format("st {:x} {} {:x}", address, bytes, value));
      return;
    }
    uint64_t value = memory.load(address, bytes);
    if (row.memory.sign_extend && bytes < 4 && (value >> (8 * bytes - 1)) & 1) value |= ~uint64_t{0} << (8 * bytes);
    reg(slot) = uint32_t(value);
    if (bytes == 8) reg(isa::Slot(slot + 1)) = uint32_t(value >> 32);
  }

  std::vector<uint32_t> registers_, constants_, specials_;
  int candidates_ = 0;
};

// Runs a VirtualProgram: every virtual register has rows of its own, and calls harm nobody.
class VirtualRun : public Lane {
 public:
  explicit VirtualRun(const VirtualProgram& program)
      : Lane(2 + 2 * program.registers.size(), 64), program_(program), predicates_(program.registers.size()) {
    for (BlockId block = 0; block != kNoBlock;) block = run_block(block);
  }

 private:
  BlockId run_block(BlockId b) {
    for (const VirtualInst& inst : program_.blocks[b].code) {
      GLINT_CHECK(++steps_ < kMaxSteps, "the virtual program does not end");
      if (inst.guard != kNoRegister && predicates_[inst.guard] == inst.guard_negate) continue;
      if (inst.kind != VirtualInst::Kind::Real) continue;
      const isa::OpRow& row = isa::op_table()[inst.op];
      if (row.effect == isa::Effect::Branch) return inst.target;
      if (row.effect == isa::Effect::Exit || row.effect == isa::Effect::Return) return kNoBlock;
      if (row.effect == isa::Effect::CallHit || row.effect == isa::Effect::CallCandidate) log.emplace_back(row.name);
      step(inst, row);
    }
    return b + 1;
  }

  void step(const VirtualInst& inst, const isa::OpRow& row) {
    isa::Inst coded;
    coded.op = inst.op;
    coded.imm = inst.imm;
    size_t slot = 0, constants = 0;
    for (isa::OperandKind kind : row.operands.view())
      for (int i = 0; i < isa::slots_of(kind); ++i, ++slot) {
        const VirtualOperand& o = inst.operands[slot];
        if (o.kind == VirtualOperand::Kind::Register && program_.registers[o.reg] == RegisterClass::Predicate) {
          coded.operand[slot] = isa::Slot(slot % isa::kNumPredicates);
          set_predicate(slot % isa::kNumPredicates, predicates_[o.reg]);
        } else if (o.kind == VirtualOperand::Kind::Register) {
          coded.operand[slot] = isa::Slot(2 + 2 * o.reg);
        } else if (o.kind == VirtualOperand::Kind::Constant) {
          coded.operand[slot] = isa::Slot(isa::kConstantBank + 2 * constants++);
          reg(coded.operand[slot]) = uint32_t(o.constant);
          reg(isa::Slot(coded.operand[slot] + 1)) = uint32_t(o.constant >> 32);
        } else if (o.kind == VirtualOperand::Kind::Special) {
          coded.operand[slot] = isa::Slot(isa::kSpecialBank + int(o.special));
        }
      }
    perform(coded);
    for (slot = 0; slot < inst.operands.size(); ++slot) {
      const VirtualOperand& o = inst.operands[slot];
      if (o.kind == VirtualOperand::Kind::Register && program_.registers[o.reg] == RegisterClass::Predicate && slot == 0)
        predicates_[o.reg] = predicate(0);
    }
  }

  const VirtualProgram& program_;
  std::vector<bool> predicates_;
};

// Runs an assembled Program. A call destroys every register but %r0, every predicate, and the stack above the frame.
class ProgramRun : public Lane {
 public:
  explicit ProgramRun(const isa::Program& program) : Lane(program.num_registers, program.constants.size()), program_(program) {
    for (size_t row = 0; row < program.constants.size(); ++row) reg(isa::Slot(isa::kConstantBank + row)) = program.constants[row];
    for (uint32_t r = 1; r < program.num_registers; ++r) reg(isa::Slot(r)) = 0xdead'0000 + r;
    for (size_t pc = 0; pc < program.code.size();) pc = step(pc);
  }
  size_t steps() const { return steps_; }

 private:
  size_t step(size_t pc) {
    GLINT_CHECK(++steps_ < kMaxSteps, "the assembled program does not end");
    const isa::Inst& inst = program_.code[pc];
    const isa::OpRow& row = isa::op_table()[inst.op];
    if (inst.guard != isa::kNoGuard) {
      const bool negate = inst.guard & isa::kGuardNegate;
      if (predicate(inst.guard & 7) == negate) return pc + 1;
    }
    if (row.effect == isa::Effect::Branch) return size_t(inst.imm);
    if (row.effect == isa::Effect::Exit || row.effect == isa::Effect::Return) return program_.code.size();
    if (row.effect == isa::Effect::CallHit || row.effect == isa::Effect::CallCandidate) {
      log.emplace_back(row.name);
      call();
      return pc + 1;
    }
    perform(inst);
    return pc + 1;
  }

  void call() {
    GLINT_CHECK_LE(program_.local_bytes, reg(0));
    for (uint32_t r = 1; r < program_.num_registers; ++r) reg(isa::Slot(r)) = 0xbad0'0000 + r;
    for (size_t p = 0; p < isa::kNumPredicates; ++p) set_predicate(p, (p + steps_) % 2);
    for (uint32_t offset = 0; offset < 256; offset += 4) local.store(reg(0) + offset, 4, 0xbad1'0000 + offset);
  }

  const isa::Program& program_;
};

}  // namespace glint::frontend::test
