// Inserts spill code: a load before each use, and a store after each definition, under the definition's
// guard.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/spill.h"

#include <cstdint>
#include <utility>

namespace glint::frontend {
namespace {

using Operand = VirtualOperand;

// Says where a spilled group is kept.
struct Home {
  bool planned = false;
  bool is_constant = false;
  uint64_t constant = 0;
  uint32_t offset = 0;                 // offset in the frame
  VirtualRegister word = kNoRegister;  // for predicates: the 32-bit register
};

class Spiller {
 public:
  Spiller(VirtualProgram& program, const Ops& ops, SpillPlan& plan)
      : program_(program), ops_(ops), plan_(plan), homes_(program.registers.size()) {}

  void run() {
    find_constants();
    make_homes();
    for (VirtualBlock& block : program_.blocks) {
      out_.clear();
      guard_ = {};
      for (VirtualInst& inst : block.code) rewrite(std::move(inst));
      block.code = out_;
    }
  }

 private:
  Home* home_of(VirtualRegister r) {
    // Registers made while rewriting have numbers beyond the plan.
    if (r == kNoRegister || r >= plan_.group.size() || plan_.group[r] == kNoRegister) return nullptr;
    return &homes_[plan_.group[r]];
  }

  VirtualRegister temporary(RegisterClass c) {
    plan_.unspillable->push_back(true);
    return program_.new_register(c);
  }

  // A group is not stored when all its definitions move the same constant; each use then moves the constant
  // again.
  void find_constants() {
    std::vector<bool> varies(homes_.size());
    for (const VirtualBlock& block : program_.blocks)
      for (const VirtualInst& inst : block.code)
        for_each_def(inst, [&](VirtualRegister r) {
          Home* home = home_of(r);
          if (!home) return;
          const bool moves_constant = (inst.op == ops_.mov_b32 || inst.op == ops_.mov_b64) &&
                                      !is_guarded(inst) && is_constant(inst.operands[1]);
          const VirtualRegister group = plan_.group[r];
          if (!moves_constant || (home->is_constant && home->constant != inst.operands[1].constant))
            varies[group] = true;
          if (!moves_constant) return;
          home->is_constant = true;
          home->constant = inst.operands[1].constant;
        });
    for (size_t group = 0; group < homes_.size(); ++group)
      if (varies[group]) homes_[group].is_constant = false;
  }

  void make_homes() {
    for (VirtualRegister r = 0; r < plan_.group.size(); ++r) {
      Home* home = home_of(r);
      if (!home || home->planned) continue;
      home->planned = true;
      if (program_.registers[r] == RegisterClass::Predicate) {
        home->word = program_.new_register(RegisterClass::B32);
        plan_.unspillable->push_back(false);
      } else if (!home->is_constant) {
        const uint32_t bytes = program_.registers[r] == RegisterClass::B64 ? 8 : 4;
        home->offset = (program_.local_bytes + bytes - 1) / bytes * bytes;
        program_.local_bytes = home->offset + bytes;
      }
    }
  }

  void emit(uint16_t op, std::vector<Operand> operands, int32_t imm, const VirtualInst& like, bool guarded) {
    VirtualInst inst = make_inst(op, std::move(operands), like.line, imm);
    if (guarded) {
      inst.guard = like.guard;
      inst.guard_negate = like.guard_negate;
    }
    out_.push_back(std::move(inst));
  }

  VirtualRegister reload(VirtualRegister r, const VirtualInst& at) {
    const Home home = *home_of(r);
    const RegisterClass c = program_.registers[r];
    const VirtualRegister value = temporary(c);
    if (c == RegisterClass::Predicate)
      emit(ops_.setp_ne, {Operand::of(value), Operand::of(home.word), Operand::value(0)}, 0, at, false);
    else if (home.is_constant)
      emit(c == RegisterClass::B64 ? ops_.mov_b64 : ops_.mov_b32,
           {Operand::of(value), Operand::value(home.constant)}, 0, at, false);
    else
      emit(c == RegisterClass::B64 ? ops_.load_b64 : ops_.load_b32,
           {Operand::of(value), Operand::stack_pointer()}, int32_t(home.offset), at, false);
    return value;
  }

  void store(const Home& home, RegisterClass c, const Operand& value, const VirtualInst& after) {
    if (c == RegisterClass::Predicate)
      emit(ops_.selp_b32, {Operand::of(home.word), Operand::value(1), Operand::value(0), value}, 0, after,
           true);
    else if (!home.is_constant)
      emit(c == RegisterClass::B64 ? ops_.store_b64 : ops_.store_b32, {Operand::stack_pointer(), value},
           int32_t(home.offset), after, true);
  }

  // Turns a move to or from a spilled register into the store or the load itself. Returns true for such a
  // move.
  bool rewrite_move(const VirtualInst& inst) {
    if (!is_real(inst) || (inst.op != ops_.mov_b32 && inst.op != ops_.mov_b64)) return false;
    if (home_of(inst.guard)) return false;
    const Home* to = home_of(inst.operands[0].reg);
    const Home* from = is_register(inst.operands[1]) ? home_of(inst.operands[1].reg) : nullptr;
    if (to && (to == from || to->is_constant)) return true;
    const RegisterClass c = program_.registers[inst.operands[0].reg];
    if (to && !from) {
      store(*to, c, inst.operands[1], inst);
      return true;
    }
    if (from && !to && from->is_constant) {
      emit(inst.op, {inst.operands[0], Operand::value(from->constant)}, 0, inst, true);
      return true;
    }
    if (from && !to) {
      emit(c == RegisterClass::B64 ? ops_.load_b64 : ops_.load_b32,
           {inst.operands[0], Operand::stack_pointer()}, int32_t(from->offset), inst, true);
      return true;
    }
    return false;
  }

  // Consecutive instructions with the same spilled guard share one reload. This saves loads, and it keeps the
  // guard's name the same: only then does LiveWalk see that a temporary which is written and read under one
  // guard is dead before it is written.
  void reload_guard(VirtualInst& inst) {
    if (!home_of(inst.guard)) {
      guard_ = {};
      return;
    }
    if (const VirtualRegister group = plan_.group[inst.guard]; guard_.group != group)
      guard_ = {group, reload(inst.guard, inst)};
    inst.guard = guard_.value;
  }

  // Gives an instruction that overwrites its own guard a copy of it, because the stores behind the
  // instruction have the same guard.
  void keep_guard(VirtualInst& inst) {
    bool overwrites = false;
    for_each_def(inst, [&](VirtualRegister r) { overwrites |= r == inst.guard; });
    if (!overwrites) return;
    const VirtualRegister kept = temporary(RegisterClass::Predicate);
    emit(ops_.mov_pred, {Operand::of(kept), Operand::of(inst.guard)}, 0, inst, false);
    inst.guard = kept;
  }

  void rewrite(VirtualInst inst) {
    if (rewrite_move(inst)) {
      guard_ = {};
      return;
    }
    std::vector<std::pair<VirtualRegister, VirtualRegister>> loaded;  // spilled register, its temporary
    const auto use = [&](VirtualRegister& r) {
      if (!home_of(r)) return;
      for (const auto& [spilled, value] : loaded)
        if (spilled == r) {
          r = value;
          return;
        }
      const VirtualRegister value = reload(r, inst);
      loaded.emplace_back(r, value);
      r = value;
    };
    reload_guard(inst);
    struct Defined {
      Home home;
      RegisterClass register_class;
      VirtualRegister value;
    };
    std::vector<Defined> defined;
    if (is_real(inst))
      for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
        Operand& operand = inst.operands[slot];
        if (!is_register(operand)) return;
        if (!isa::is_destination(kind)) {
          use(operand.reg);
        } else if (const Home* home = home_of(operand.reg)) {
          const RegisterClass c = program_.registers[operand.reg];
          if (plan_.group[operand.reg] == guard_.group) guard_ = {};
          operand.reg = temporary(c);
          defined.push_back({*home, c, operand.reg});
        }
      });
    if (!defined.empty()) keep_guard(inst);
    out_.push_back(inst);
    for (const Defined& d : defined) store(d.home, d.register_class, Operand::of(d.value), inst);
  }

  VirtualProgram& program_;
  const Ops& ops_;
  SpillPlan& plan_;
  std::vector<Home> homes_;
  std::vector<VirtualInst> out_;
  struct Guard {
    VirtualRegister group = kNoRegister, value = kNoRegister;
  } guard_;  // reloaded for the previous instruction
};

}  // namespace

void spill(VirtualProgram& program, const Ops& ops, SpillPlan& plan) {
  Spiller(program, ops, plan).run();
}

}  // namespace glint::frontend
