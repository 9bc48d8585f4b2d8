// Checks that a machine can run a program (isa/verify.h).
// SPDX-License-Identifier: Apache-2.0
#include "isa/verify.h"

#include <fmt/format.h>

#include "isa/op_row.h"
#include "isa/text.h"

namespace glint::isa {
namespace {

class Verifier {
 public:
  Verifier(const Program& program, Diagnostics& diagnostics) : program_(program), diagnostics_(diagnostics) {}

  void run() {
    header();
    for (at_ = 0; at_ < program_.code.size(); ++at_) instruction(program_.code[at_]);
    last_instruction();
  }

 private:
  void header() {
    if (program_.num_registers < 1 || program_.num_registers > uint32_t(kMaxRegisters))
      whole(fmt::format("{} registers, expected 1 to {}", program_.num_registers, kMaxRegisters));
    if (program_.constants.size() > size_t(kSlotIndexMask))
      whole(fmt::format("{} constant rows, expected at most {}", program_.constants.size(), kSlotIndexMask));
    if (program_.lines.size() != program_.code.size())
      whole(fmt::format("{} source lines for {} instructions", program_.lines.size(), program_.code.size()));
    for (const auto& [index, name] : program_.labels)
      if (index > program_.code.size())
        whole(fmt::format("label '{}' stands past the end of the code", name));
  }

  void instruction(const Inst& inst) {
    row_ = nullptr;
    if (inst.op >= op_table().size()) return error(fmt::format("op {} is not in the table", inst.op));
    row_ = &op_table()[inst.op];
    if (inst.guard != kNoGuard && (inst.guard & ~kGuardNegate) >= kNumPredicates)
      error(fmt::format("guard %p{}, expected %p0 to %p{}", inst.guard & ~kGuardNegate, kNumPredicates - 1));
    if (at_ < program_.lines.size() && program_.lines[at_].line &&
        program_.lines[at_].file >= program_.files.size())
      error(fmt::format("source file {} is not declared", program_.lines[at_].file));
    int slot = 0;
    bool has_imm = false;
    operand_ = 0;
    for (const OperandKind kind : row_->operands.view()) {
      ++operand_;
      has_imm |=
          kind == OperandKind::Label || kind == OperandKind::Address32 || kind == OperandKind::Address64;
      if (kind == OperandKind::Label) target(inst);
      for (const int end = slot + slots_of(kind); slot < end; ++slot) one_slot(kind, inst.operand[slot]);
    }
    operand_ = 0;
    for (; slot < kMaxOperands; ++slot)
      if (inst.operand[slot]) error(fmt::format("operand slot {} is set, and the op does not have it", slot));
    if (!has_imm && inst.imm) error("an immediate, and the op has neither address nor label");
  }

  void target(const Inst& inst) {
    if (inst.imm < 0 || size_t(inst.imm) >= program_.code.size())
      return error(fmt::format("target {} lies outside the code (0 to {})", inst.imm,
                               int64_t(program_.code.size()) - 1));
    if (row_->effect != Effect::PushReconvergence) return;
    const uint16_t op = program_.code[inst.imm].op;
    if (op >= op_table().size() || op_table()[op].effect != Effect::Join)
      error(fmt::format("instruction {}, where the lanes should meet, is not a join", inst.imm));
  }

  void one_slot(OperandKind kind, Slot slot) {
    const unsigned index = slot & kSlotIndexMask;
    if (kind == OperandKind::DstPred || kind == OperandKind::SrcPred) {
      if (slot >= kNumPredicates)
        error(fmt::format("predicate %p{}, expected %p0 to %p{}", slot, kNumPredicates - 1));
      return;
    }
    const bool is_wide =
        kind == OperandKind::Dst64 || kind == OperandKind::Src64 || kind == OperandKind::Address64;
    const unsigned end = index + (is_wide ? 2 : 1);
    switch (slot & ~kSlotIndexMask) {
      case kRegisterBank:
        if (end > program_.num_registers)
          error(fmt::format("register %r{}, and the program has {}", end - 1, program_.num_registers));
        if (is_wide && index % 2) error(fmt::format("pair %rd{} starts at an odd register", index));
        return;
      case kConstantBank:
        if (is_destination(kind)) error("a constant as destination");
        if (end > program_.constants.size())
          error(fmt::format("constant row {}, and the program has {}", end - 1, program_.constants.size()));
        return;
      case kSpecialBank:
        return special(kind, index, is_wide);
      default:
        error(fmt::format("slot 0x{:x} names no bank", slot));
    }
  }

  void special(OperandKind kind, unsigned index, bool is_wide) {
    if (is_destination(kind)) error("a special as destination");
    if (is_wide) error("a special as 64-bit operand");
    if (index >= unsigned(kNumSpecials)) error(fmt::format("special {}, and there are {}", index, kNumSpecials));
  }

  // Code runs off its end unless the last instruction ends or moves every lane.
  void last_instruction() {
    if (program_.code.empty()) return whole("no instructions");
    at_ = program_.code.size() - 1;
    const Inst& last = program_.code.back();
    if (last.op >= op_table().size()) return;
    row_ = &op_table()[last.op];
    const Effect e = row_->effect;
    const bool leaves = e == Effect::Branch || e == Effect::Exit || e == Effect::Return ||
                        e == Effect::Ignore || e == Effect::Terminate;
    if (!leaves || last.guard != kNoGuard) error("the code can run off its end here");
  }

  void whole(const std::string& what) { diagnostics_.error({program_.name, 0, 0}, what); }
  void error(const std::string& what) {
    SourceLocation where{program_.name, 0, 0};
    if (at_ < program_.lines.size() && program_.lines[at_].line &&
        program_.lines[at_].file < program_.files.size())
      where = {program_.files[program_.lines[at_].file], int(program_.lines[at_].line), 0};
    const std::string op = row_ ? fmt::format(" ({})", row_->name) : "";
    const std::string operand = operand_ ? fmt::format(", operand {}", operand_) : "";
    diagnostics_.error(where, fmt::format("instruction {}{}{}: {}", at_, op, operand, what));
  }

  const Program& program_;
  Diagnostics& diagnostics_;
  const OpRow* row_ = nullptr;
  size_t at_ = 0;
  int operand_ = 0;  // counts from 1; 0: the instruction as a whole
};

}  // namespace

void verify(const Program& program, Diagnostics& diagnostics) {
  Verifier(program, diagnostics).run();
}

}  // namespace glint::isa
