// Steps virtual programs lane by lane and assembled programs as a diverging warp, with the op table's own
// handlers, and records what each lane does to memory and rays. Equal records show that assembling has kept a
// program's meaning.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/check.h"
#include "exec/simt_stack.h"
#include "frontend/virtual_program.h"

namespace glint::frontend::test {

// Lists the effects of a lane in order: "st.global 100 4 2a", "call.sbt.hit", "rt.trace ...".
using Log = std::vector<std::string>;

// Holds bytes by address. A byte that was never written reads as a hash of its address.
class Bytes {
 public:
  uint64_t load(uint64_t address, int bytes) const {
    uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) {
      const auto at = bytes_.find(address + uint64_t(i));
      const uint64_t byte =
          at != bytes_.end() ? at->second : ((address + uint64_t(i)) * 0x9e3779b97f4a7c15u) >> 56;
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

// Holds what one lane owns. Lanes share no memory in this test, so their order cannot matter.
struct LaneWorld {
  Log log;
  Bytes global, local;
  int candidates = 0;  // intersection shaders for which its ray still waits
};

// Holds the registers of a warp and performs single instructions.
class Machine {
 public:
  static constexpr size_t kMaxSteps = 400'000;  // a program that runs longer is stuck

  Machine(size_t registers, size_t constants)
      : registers_(registers * kLanes + 16),
        constants_(constants * kLanes + 16),
        specials_(isa::kNumSpecials * kLanes + 16) {
    warp_ = std::make_unique<isa::Warp>();
    warp_->bank = {aligned(registers_), aligned(constants_), aligned(specials_)};
    for (int s = 0; s < isa::kNumSpecials; ++s)
      for (int lane = 0; lane < kLanes; ++lane)
        warp_->bank[2][s * kLanes + lane] = 0x1000u + 77u * uint32_t(s) + 1013u * uint32_t(lane);
  }

  std::array<LaneWorld, kLanes> lanes;

 protected:
  uint32_t& reg(isa::Slot slot, int lane) {
    return warp_->bank[slot >> isa::kBankShift][(slot & isa::kSlotIndexMask) * kLanes + lane];
  }
  LaneMask& predicate(size_t p) { return warp_->predicate[p]; }
  void set_predicate(size_t p, int lane, bool value) {
    predicate(p) = (predicate(p) & ~(LaneMask{1} << lane)) | LaneMask{value} << lane;
  }
  uint64_t read(isa::Slot slot, int lane, bool is_pair) {
    return reg(slot, lane) | (is_pair ? uint64_t{reg(isa::Slot(slot + 1), lane)} << 32 : 0);
  }

  // Runs the handler, and what the op does beyond its registers, except control flow.
  void perform(const isa::Inst& inst, LaneMask exec) {
    const isa::OpRow& row = isa::op_table()[inst.op];
    warp_->exec = exec;
    row.run(*warp_, inst, row);
    for_each_lane(exec, [&](int lane) {
      LaneWorld& world = lanes[size_t(lane)];
      if (row.effect == isa::Effect::Load || row.effect == isa::Effect::Store) access(inst, row, lane);
      if (row.effect != isa::Effect::Trace && row.effect != isa::Effect::Resume) return;
      std::string text(row.name);
      if (row.effect == isa::Effect::Trace) {
        world.candidates = lane % 3;
        for (size_t k = 1; k <= 16; ++k) text += fmt::format(" {:x}", read(inst.operand[k], lane, k == 1));
      }
      world.log.push_back(text);
      set_predicate(inst.operand[0], lane, world.candidates-- > 0);
    });
  }

  std::unique_ptr<isa::Warp> warp_;
  size_t steps_ = 0;

 private:
  static uint32_t* aligned(std::vector<uint32_t>& words) {
    void* at = words.data();
    size_t space = words.size() * 4;
    return static_cast<uint32_t*>(std::align(64, 64, at, space));
  }

  void access(const isa::Inst& inst, const isa::OpRow& row, int lane) {
    const bool is_store = row.effect == isa::Effect::Store;
    const uint64_t address = warp_->access.address[size_t(lane)];
    size_t slot = 0, part = 0;
    for (isa::OperandKind kind : row.operands.view()) {
      const bool is_address = kind == isa::OperandKind::Address32 || kind == isa::OperandKind::Address64;
      for (int i = 0; i < isa::slots_of(kind); ++i, ++slot) {
        if (is_address) continue;
        move_part(row, lane, address + part++ * row.memory.bytes, inst.operand[slot], is_store);
      }
    }
  }

  void move_part(const isa::OpRow& row, int lane, uint64_t address, isa::Slot slot, bool is_store) {
    LaneWorld& world = lanes[size_t(lane)];
    Bytes& memory = row.memory.space == isa::Space::Local ? world.local : world.global;
    const int bytes = row.memory.bytes;
    if (is_store) {
      const uint64_t value =
          read(slot, lane, bytes == 8) & (bytes == 8 ? ~uint64_t{0} : (uint64_t{1} << (8 * bytes)) - 1);
      memory.store(address, bytes, value);
      if (row.memory.space == isa::Space::Global)
        world.log.push_back(fmt::format("st {:x} {} {:x}", address, bytes, value));
      return;
    }
    uint64_t value = memory.load(address, bytes);
    if (row.memory.sign_extend && bytes < 4 && (value >> (8 * bytes - 1)) & 1)
      value |= ~uint64_t{0} << (8 * bytes);
    reg(slot, lane) = uint32_t(value);
    if (bytes == 8) reg(isa::Slot(slot + 1), lane) = uint32_t(value >> 32);
  }

  std::vector<uint32_t> registers_, constants_, specials_;
};

// Runs one lane of a VirtualProgram. Every virtual register has rows of its own, and calls destroy nothing.
class VirtualRun : public Machine {
 public:
  VirtualRun(const VirtualProgram& program, int lane)
      : Machine(2 + 2 * program.registers.size(), 64),
        program_(program),
        lane_(lane),
        predicates_(program.registers.size()) {
    for (BlockId block = 0; block != kNoBlock;) block = run_block(block);
  }
  const LaneWorld& world() const { return lanes[size_t(lane_)]; }

 private:
  BlockId run_block(BlockId b) {
    for (const VirtualInst& inst : program_.blocks[b].code) {
      GLINT_CHECK(++steps_ < kMaxSteps, "the virtual program does not end");
      if (inst.guard != kNoRegister && predicates_[inst.guard] == inst.guard_negate) continue;
      if (inst.kind != VirtualInst::Kind::Real) continue;
      const isa::OpRow& row = isa::op_table()[inst.op];
      if (row.effect == isa::Effect::Branch) return inst.target;
      if (row.effect == isa::Effect::Exit || row.effect == isa::Effect::Return) return kNoBlock;
      if (row.effect == isa::Effect::CallHit || row.effect == isa::Effect::CallCandidate)
        lanes[size_t(lane_)].log.emplace_back(row.name);
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
      for (int i = 0; i < isa::slots_of(kind); ++i, ++slot)
        coded.operand[slot] = place(inst.operands[slot], slot, constants);
    perform(coded, LaneMask{1} << lane_);
    slot = 0;
    for (isa::OperandKind kind : row.operands.view()) {
      if (kind == isa::OperandKind::DstPred)
        predicates_[inst.operands[slot].reg] = (predicate(slot % isa::kNumPredicates) >> lane_) & 1;
      slot += size_t(isa::slots_of(kind));
    }
  }

  isa::Slot place(const VirtualOperand& o, size_t slot, size_t& constants) {
    switch (o.kind) {
      case VirtualOperand::Kind::Register: {
        if (program_.registers[o.reg] != RegisterClass::Predicate) return isa::Slot(2 + 2 * o.reg);
        const size_t p = slot % isa::kNumPredicates;
        set_predicate(p, lane_, predicates_[o.reg]);
        return isa::Slot(p);
      }
      case VirtualOperand::Kind::Constant: {
        const isa::Slot row = isa::Slot(isa::kConstantBank + 2 * constants++);
        reg(row, lane_) = uint32_t(o.constant);
        reg(isa::Slot(row + 1), lane_) = uint32_t(o.constant >> 32);
        return row;
      }
      case VirtualOperand::Kind::Special:
        return isa::Slot(isa::kSpecialBank + int(o.special));
      case VirtualOperand::Kind::StackPointer:
      case VirtualOperand::Kind::None:
        break;
    }
    return isa::kStackPointer;
  }

  const VirtualProgram& program_;
  const int lane_;
  std::vector<bool> predicates_;
};

// Runs an assembled Program for a whole warp (docs/abi.md, "Control flow"). A call destroys every register
// except %r0, every predicate, and the stack above the frame.
class ProgramRun : public Machine {
 public:
  explicit ProgramRun(const isa::Program& program)
      : Machine(program.num_registers, program.constants.size()), program_(program) {
    for (int lane = 0; lane < kLanes; ++lane) {
      for (size_t row = 0; row < program.constants.size(); ++row)
        reg(isa::Slot(isa::kConstantBank + row), lane) = program.constants[row];
      for (uint32_t r = 1; r < program.num_registers; ++r) reg(isa::Slot(r), lane) = 0xdead'0000 + r;
    }
    stack_.start(0, kAllLanes);
    while (!stack_.finished()) step();
    GLINT_CHECK_EQ(stack_.depth(), size_t{0});
  }

 private:
  void step() {
    GLINT_CHECK(++steps_ < kMaxSteps, "the assembled program does not end");
    const isa::Inst& inst = program_.code[stack_.pc];
    const isa::OpRow& row = isa::op_table()[inst.op];
    LaneMask exec = stack_.active;
    if (inst.guard != isa::kNoGuard)
      exec &= inst.guard & isa::kGuardNegate ? ~predicate(inst.guard & 7) : predicate(inst.guard & 7);
    const uint32_t pc = stack_.pc++;
    if (row.effect == isa::Effect::Branch) {
      branch(exec, uint32_t(inst.imm));
    } else if (row.effect == isa::Effect::PushReconvergence) {
      stack_.push_reconvergence(uint32_t(inst.imm));
    } else if (row.effect == isa::Effect::Join) {
      GLINT_CHECK(stack_.arrive(pc, stack_.active), "no ssy names the join at {}", pc);
      stack_.active = 0;
    } else if (row.effect == isa::Effect::Exit || row.effect == isa::Effect::Return) {
      stack_.active &= ~exec;
    } else {
      if (row.effect == isa::Effect::CallHit || row.effect == isa::Effect::CallCandidate) call(row, exec);
      perform(inst, exec);
    }
    exec::SimtStack::Entry resumed;
    if (stack_.active == 0) stack_.resume_next(&resumed);
  }

  void branch(LaneMask taken, uint32_t target) {
    const LaneMask others = stack_.active & ~taken;
    if (!taken) return;
    if (isa::op_table()[program_.code[target].op].effect == isa::Effect::Join) {
      GLINT_CHECK(stack_.arrive(target, taken), "no ssy names the join at {}", target);
      stack_.active = others;
    } else if (!others) {
      stack_.pc = target;
    } else {
      stack_.push_path(target, taken);
      stack_.active = others;
    }
  }

  void call(const isa::OpRow& row, LaneMask exec) {
    for_each_lane(exec, [&](int lane) {
      lanes[size_t(lane)].log.emplace_back(row.name);
      GLINT_CHECK_LE(program_.local_bytes, reg(0, lane));
      for (uint32_t r = 1; r < program_.num_registers; ++r) reg(isa::Slot(r), lane) = 0xbad0'0000 + r;
      for (size_t p = 0; p < isa::kNumPredicates; ++p) set_predicate(p, lane, (p + steps_) % 2);
      for (uint32_t offset = 0; offset < 64; offset += 4)
        lanes[size_t(lane)].local.store(reg(0, lane) + offset, 4, 0xbad1'0000 + offset);
    });
  }

  const isa::Program& program_;
  exec::SimtStack stack_;
};

}  // namespace glint::frontend::test
