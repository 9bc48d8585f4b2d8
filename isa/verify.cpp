// Checks that a machine can run a program (isa/verify.h).
// SPDX-License-Identifier: Apache-2.0
#include "isa/verify.h"

#include <algorithm>
#include <bitset>
#include <cctype>
#include <fmt/format.h>

#include "isa/descriptors.h"
#include "isa/hit_object.h"
#include "isa/message.h"
#include "isa/op_row.h"
#include "isa/text.h"
#include "isa/verify_flow.h"

namespace glint::isa {
namespace {

class Verifier {
 public:
  Verifier(const Program& program, Diagnostics& diagnostics) : program_(program), diagnostics_(diagnostics) {}

  void run() {
    header();
    for (at_ = 0; at_ < program_.code.size(); ++at_) instruction(program_.code[at_]);
    if (program_.code.empty()) whole("the program has no instructions");
    if (!is_sound_) return;  // paths make sense only if every target and operand does
    const Complaint complain = [this](size_t at, const std::string& what) {
      at_ = at;
      row_ = &op_table()[program_.code[at].op];
      error(what);
    };
    if (verify_regions(program_, complain)) verify_values(program_, complain);
  }

 private:
  void header() {
    if (program_.num_registers < 1 || program_.num_registers > uint32_t(kMaxRegisters))
      whole(fmt::format("{} registers, expected 1 to {}", program_.num_registers, kMaxRegisters));
    if (program_.constants.size() >= size_t(kSlotIndexMask))
      whole(fmt::format("{} constant rows, expected at most {}", program_.constants.size(),
                        kSlotIndexMask - 1));
    if (program_.lines.size() != program_.code.size())
      whole(fmt::format("{} source lines for {} instructions", program_.lines.size(), program_.code.size()));
    for (const std::string& text : program_.messages)
      if (const ParsedMessage parsed = parse_message(text); !parsed.error.empty())
        whole(fmt::format("message '{}': {}", text, parsed.error));
    for (const auto& [index, name] : program_.labels)
      if (index > program_.code.size())
        whole(fmt::format("label '{}' stands past the end of the code", name));
      else if (!is_word(name))
        whole(fmt::format("label '{}' is not a word of letters, digits, '_', '$' and '.'", name));
  }

  static bool is_word(const std::string& name) {
    return !name.empty() && name[0] != '.' && std::all_of(name.begin(), name.end(), [](unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '.' || c == '$' || c == '%';
    });
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
      if (inst.operand[slot]) error(fmt::format("operand slot {} is set, but the op does not have it", slot));
    if (!has_imm && inst.imm) error("there is an immediate, but the op has neither address nor label");
    stage_of_op();
    message(inst);
    constant_address(inst);
    destinations_differ(inst);
    if (!effect_row(row_->effect).takes_guard && inst.guard != kNoGuard)
      error("there is a guard, but the op moves all lanes of the warp");
  }

  // Checks that the op means something in the program's stage.
  void stage_of_op() {
    only(effect_row(row_->effect).stages);
    if (row_->effect == Effect::HitObject || row_->effect == Effect::Reorder)
      only(stages_of(HitObjectOp(row_->detail)));
    if (row_->memory.space == Space::Shared) only({Stage::Compute});
  }
  void only(StageSet stages) {
    if (stages.contains(program_.stage)) return;
    std::string names;
    for (int s = 0; s < kNumStages; ++s)
      if (stages.contains(Stage(s)))
        names += fmt::format("{}{}", names.empty() ? "" : ", ", name_of(Stage(s)));
    error(fmt::format("stands in a shader of stage {}, but belongs in {}", name_of(program_.stage), names));
  }

  // Checks a constant address, which must lie in the memory that the program declares.
  void constant_address(const Inst& inst) {
    int slot = 0;
    for (const OperandKind kind : row_->operands.view()) {
      const Slot base = inst.operand[size_t(slot)];
      const size_t index = base & kSlotIndexMask;
      if (kind == OperandKind::Address32 && base >> kBankShift == kConstantBank >> kBankShift &&
          index < program_.constants.size())
        inside(int64_t(program_.constants[index]) + inst.imm);
      slot += slots_of(kind);
    }
  }
  void inside(int64_t first) {
    const Space space = row_->memory.space;
    const int64_t end = first + row_->memory.bytes * row_->memory.count;
    const int64_t size = space == Space::Shared                         ? int64_t(program_.shared_bytes)
                         : space == Space::Local && program_.is_entry() ? int64_t(program_.local_bytes)
                         : space == Space::Const                        ? int64_t(kLargestBankBytes)
                         : space == Space::Param ? int64_t(kConstantBankBytes - kPushConstantOffset)
                                                 : INT64_MAX;
    if (first < 0 || end > size)
      error(fmt::format("touches bytes {} to {}, but there are {}", first, end - 1, size));
  }

  // Checks that the message named by a print exists. Its number must be a constant.
  void message(const Inst& inst) {
    if (effect_row(row_->effect).family != EffectFamily::Print) return;
    const size_t row = inst.operand[0] & kSlotIndexMask;
    if (inst.operand[0] >> kBankShift != kConstantBank >> kBankShift || row >= program_.constants.size())
      return error("the number of the message is not a constant");
    if (program_.constants[row] >= program_.messages.size())
      error(fmt::format("there is no message {}: the program has {}", program_.constants[row],
                        program_.messages.size()));
  }

  // Checks that no register or predicate is written twice.
  void destinations_differ(const Inst& inst) {
    uint32_t predicates = 0;
    std::bitset<size_t(kSlotIndexMask) + 2> registers;
    int slot = 0;
    for (const OperandKind kind : row_->operands.view()) {
      for (const int end = slot + slots_of(kind); slot < end; ++slot) {
        const Slot s = inst.operand[size_t(slot)];
        if (!is_destination(kind) || s > kSlotIndexMask) continue;
        const bool is_predicate = kind == OperandKind::DstPred;
        const bool is_wide = kind == OperandKind::Dst64;
        if (is_predicate ? predicates >> (s & 31) & 1 : registers[s] || (is_wide && registers[s + 1u]))
          error(fmt::format("%{}{} is written twice", is_predicate ? 'p' : 'r', s));
        if (is_predicate)
          predicates |= 1u << (s & 31);
        else
          registers[s] = registers[s + (is_wide ? 1u : 0u)] = true;
      }
    }
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
          error(
              fmt::format("there is no register %r{}: the program has {}", end - 1, program_.num_registers));
        if (is_wide && index % 2) error(fmt::format("pair %rd{} starts at an odd register", index));
        return;
      case kConstantBank:
        if (is_destination(kind)) error("a constant cannot be a destination");
        if (end > program_.constants.size())
          error(fmt::format("there is no constant row {}: the program has {}", end - 1,
                            program_.constants.size()));
        return;
      case kSpecialBank:
        return special(kind, index, is_wide);
      default:
        error(fmt::format("slot 0x{:x} names no bank", slot));
    }
  }

  void special(OperandKind kind, unsigned index, bool is_wide) {
    if (is_destination(kind)) error("a special cannot be a destination");
    if (is_wide) error("a special cannot be a 64-bit operand");
    if (index >= unsigned(kNumSpecials))
      return error(fmt::format("there is no special {}: there are {}", index, kNumSpecials));
    stage_of_special(Special(index));
  }

  // Checks the stage of a special: SPV_KHR_ray_tracing's table of built-ins, and blocks, which only compute
  // launches have.
  void stage_of_special(Special s) {
    using enum Stage;
    if (s >= Special::TidX && s <= Special::NctaidZ) return only({Compute});
    if (s < Special::Payload) return;
    if (s == Special::Payload) return only({AnyHit, ClosestHit, Miss, Callable});
    if (s == Special::Record || s == Special::RecordHi)
      return only({RayGeneration, Intersection, AnyHit, ClosestHit, Miss, Callable});
    if (s == Special::HitT || (s >= Special::RayFlags && s <= Special::RayDirectionZ))
      return only({Intersection, AnyHit, ClosestHit, Miss});
    only({Intersection, AnyHit, ClosestHit});
  }

  void whole(const std::string& what) {
    is_sound_ = false;
    diagnostics_.error({program_.name, 0, 0}, what);
  }
  void error(const std::string& what) {
    is_sound_ = false;
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
  bool is_sound_ = true;
  int operand_ = 0;  // counts from 1; 0: the instruction as a whole
};

}  // namespace

void verify(const Program& program, Diagnostics& diagnostics) {
  Verifier(program, diagnostics).run();
}

}  // namespace glint::isa
