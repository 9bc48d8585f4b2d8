// Finds atomics at addresses that all lanes of a warp share.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/aggregation.h"

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frontend/backend/def_use.h"

namespace glint::frontend::ptx {
namespace {

bool is_same_for_a_warp(isa::Special s) {
  return s >= isa::Special::NtidX && s <= isa::Special::NctaidZ;
}

// Says whether registers hold the same value in all lanes of a warp.
class Sameness {
 public:
  explicit Sameness(VirtualProgram& program) : registers_(program), known_(program.registers.size()) {}
  bool holds(const VirtualOperand& o, int depth = 0) {
    if (is_constant(o)) return true;
    if (o.kind == VirtualOperand::Kind::Special) return is_same_for_a_warp(o.special);
    constexpr int kDeepest = 16;
    const VirtualInst* source = depth < kDeepest ? registers_.definition(o) : nullptr;
    if (!source) return false;
    std::optional<bool>& known = known_[o.reg];
    if (!known) known = computes_same(*source, depth);
    return *known;
  }

 private:
  bool computes_same(const VirtualInst& source, int depth) {
    const bool is_parameter = row_of(source).memory.space == isa::Space::Param;
    if (!is_pure(source) || (!is_parameter && row_of(source).effect != isa::Effect::None)) return false;
    if (isa::depends_on_lanes(row_of(source))) return false;
    bool all = true;
    for_each_slot(row_of(source), [&](size_t slot, isa::OperandKind kind) {
      if (!isa::is_destination(kind)) all &= holds(source.operands[slot], depth + 1);
    });
    return all;
  }
  DefUse registers_;
  std::vector<std::optional<bool>> known_;
};

class Aggregation {
 public:
  explicit Aggregation(VirtualProgram& program) : program_(program) {}

  void run() {
    // All are found before the first is rewritten, which moves instructions.
    Sameness same(program_);
    for (const VirtualBlock& block : program_.blocks)
      for (const VirtualInst& inst : block.code)
        if (is_candidate(inst) && same.holds(inst.operands[inst.operands.size() - 2])) found_.insert(&inst);
    if (found_.empty()) return;
    for (VirtualBlock& block : program_.blocks) {
      std::vector<VirtualInst> code;
      for (VirtualInst& inst : block.code)
        if (found_.contains(&inst))
          rewrite(inst, code);
        else
          code.push_back(std::move(inst));
      block.code = std::move(code);
    }
  }

 private:
  static std::string_view kind_of(const VirtualInst& inst) {
    const std::string_view name = row_of(inst).name;
    return name.substr(name.find(".global.") + 8);  // add.u32, max.s32, or.b32 ...
  }
  static bool returns(const VirtualInst& inst) { return row_of(inst).name.starts_with("atom."); }
  // Returns whether the lanes all add the same constant.
  static bool counts(const VirtualInst& inst) {
    return kind_of(inst).starts_with("add.") && is_constant(inst.operands.back());
  }
  static int reduction_of(const VirtualInst& inst) {
    return isa::find_op("redux.sync." + std::string(kind_of(inst)));
  }
  static bool is_candidate(const VirtualInst& inst) {
    if (!is_real(inst) || is_guarded(inst)) return false;
    const std::string_view name = row_of(inst).name;
    const bool reduces = name.starts_with("red.global."), is_sum = name.starts_with("atom.global.add.");
    return (reduces || (is_sum && counts(inst))) && reduction_of(inst) >= 0;
  }

  // Appends what replaces the instruction.
  void rewrite(const VirtualInst& inst, std::vector<VirtualInst>& code) {
    const VirtualOperand value = inst.operands.back();
    const size_t at = inst.operands.size() - 1;  // place of the value
    line_ = &inst.line;
    code_ = &code;
    const VirtualOperand mask = put("activemask.b32", {}), leader = put("bfind.u32", {mask});
    const VirtualOperand lane = put("mov.b32", {VirtualOperand::of(isa::Special::LaneId)});
    const VirtualOperand leads = VirtualOperand::of(program_.new_register(RegisterClass::Predicate));
    emit(isa::op_index("setp.eq.u32"), {leads, lane, leader});
    const VirtualOperand all =
        counts(inst) ? times(put("popc.b32", {mask}), value) : put_row(reduction_of(inst), {value, mask});
    VirtualInst one = inst;
    one.guard = leads.reg;
    one.operands[at] = all;
    if (!returns(inst)) return code.push_back(std::move(one));
    one.operands[0] = put("mov.b32", {VirtualOperand::value(0)});
    code.push_back(one);
    const VirtualOperand below =
        put("and.b32", {put("mov.b32", {VirtualOperand::of(isa::Special::LanemaskLt)}), mask});
    const VirtualOperand before = times(put("popc.b32", {below}), value);
    const VirtualOperand old = VirtualOperand::of(program_.new_register(RegisterClass::B32));
    const VirtualOperand inside = VirtualOperand::of(program_.new_register(RegisterClass::Predicate));
    emit(isa::op_index("shfl.sync.idx.b32"),
         {old, inside, one.operands[0], leader, VirtualOperand::value(31), mask});
    emit(isa::op_index("add.u32"), {inst.operands[0], old, before});
  }

  VirtualOperand times(const VirtualOperand& count, const VirtualOperand& value) {
    return uint32_t(value.constant) == 1 ? count : put("mul.lo.u32", {count, value});
  }
  VirtualOperand put(std::string_view op, std::vector<VirtualOperand> sources) {
    return put_row(isa::op_index(op), std::move(sources));
  }
  VirtualOperand put_row(int op, std::vector<VirtualOperand> sources) {
    const VirtualOperand to = VirtualOperand::of(program_.new_register(RegisterClass::B32));
    sources.insert(sources.begin(), to);
    emit(uint16_t(op), std::move(sources));
    return to;
  }
  void emit(uint16_t op, std::vector<VirtualOperand> operands) {
    code_->push_back(make_inst(op, std::move(operands), *line_));
  }

  VirtualProgram& program_;
  std::set<const VirtualInst*> found_;
  const isa::Line* line_ = nullptr;           // of the instruction that is rewritten
  std::vector<VirtualInst>* code_ = nullptr;  // where the new instructions go
};

}  // namespace

void aggregate_atomics(VirtualProgram& program) {
  Aggregation(program).run();
}

}  // namespace glint::frontend::ptx
