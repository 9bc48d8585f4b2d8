// Names the registers of each copy, and takes sums with stepping registers from the first one.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/loop_body.h"

#include <algorithm>
#include <utility>

namespace glint::frontend::ptx {
namespace {

VirtualOperand constant_of(int64_t value, bool wide) {
  return VirtualOperand::value(wide ? uint64_t(value) : uint64_t(uint32_t(value)));
}

}  // namespace

LoopBody::LoopBody(Draft& draft, VirtualProgram& program, BlockId at)
    : draft_(draft), program_(program), at_(at) {
  for (const VirtualInst& inst : block().code)
    for_each_def(inst, [&](VirtualRegister r) { ++definitions_[r]; });
  find_kept();
  for (const VirtualInst& inst : block().code)
    if (const auto step = step_of(inst)) steps_[inst.operands[0].reg] = *step;
}

void LoopBody::find_kept() {
  std::set<VirtualRegister> written;
  for (const VirtualInst& inst : block().code) {
    for_each_use(inst, [&](VirtualRegister r) {
      if (writes(r) && !written.contains(r)) kept_.insert(r);
    });
    for_each_def(inst, [&](VirtualRegister r) { written.insert(r); });
  }
  for (BlockId b = 0; b < draft_.blocks.size(); ++b) {
    if (b == at_) continue;
    for (const VirtualInst& inst : draft_.blocks[b].code)
      for_each_use(inst, [&](VirtualRegister r) {
        if (writes(r)) kept_.insert(r);
      });
    if (writes(draft_.blocks[b].condition)) kept_.insert(draft_.blocks[b].condition);
  }
}

std::optional<int64_t> LoopBody::step(VirtualRegister r) const {
  const auto found = steps_.find(r);
  return found == steps_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<int64_t> LoopBody::step_of(const VirtualInst& inst) const {
  const bool narrow = inst.op == ops_.add_s32 || inst.op == ops_.add_u32,
             wide = inst.op == ops_.add_s64 || inst.op == ops_.add_u64;
  if (!narrow && !wide) return std::nullopt;
  const VirtualOperand &to = inst.operands[0], &from = inst.operands[1], &by = inst.operands[2];
  if (!is_register(from) || from.reg != to.reg || !is_constant(by) || !writes_once(to.reg))
    return std::nullopt;
  const int64_t step = narrow ? int64_t{int32_t(uint32_t(by.constant))} : int64_t(by.constant);
  constexpr int64_t kMost = 1 << 24;
  return step > -kMost && step < kMost ? std::optional(step) : std::nullopt;
}

void LoopBody::begin_copies() {
  stepped_.clear(), names_.clear(), values_.clear(), starts_.clear(), first_.clear();
}

VirtualInst LoopBody::constant_move(VirtualRegister to, uint64_t value, const isa::Line& line) const {
  return make_inst(is_wide(to) ? ops_.mov_b64 : ops_.mov_b32,
                   {VirtualOperand::of(to), constant_of(int64_t(value), is_wide(to))}, line);
}

void LoopBody::starts_with(VirtualRegister r, uint64_t value, std::vector<VirtualInst>& code) {
  const VirtualRegister fresh = program_.new_register(program_.registers[r]);
  code.push_back(constant_move(fresh, value, block().line));
  names_[r] = fresh, values_[fresh] = value, starts_[r] = value;
}

VirtualOperand LoopBody::now(const VirtualOperand& o) const {
  if (!is_register(o)) return o;
  const auto found = names_.find(o.reg);
  return found == names_.end() ? o : VirtualOperand::of(found->second);
}

void LoopBody::copy(int64_t turn, bool last, std::vector<VirtualInst>& code) {
  const std::vector<VirtualInst> body = block().code;
  for (size_t i = 0; i + 1 < body.size(); ++i) {  // leaves out the test
    VirtualInst inst = body[i];
    const auto step = step_of(inst);
    const VirtualRegister from = step ? inst.operands[0].reg : kNoRegister;
    if (step && starts_.contains(from)) {
      const uint64_t value = starts_.at(from) + uint64_t((turn + 1) * *step);
      inst = constant_move(from, value, inst.line);
    } else if (step) {
      inst.operands[2] = constant_of((turn + 1) * *step, is_wide(from));
      stepped_[from] = turn + 1;
    } else if (!take_from_first(inst, turn, i)) {
      for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
        if (!isa::is_destination(kind)) inst.operands[slot] = now(inst.operands[slot]);
      });
    }
    name_results(inst, last);
    if (turn == 0 && !inst.operands.empty()) first_[i] = inst.operands[0];
    code.push_back(std::move(inst));
  }
}

// Gives what an instruction of a copy writes a name of its own, and keeps its value if that is known.
void LoopBody::name_results(VirtualInst& inst, bool last) {
  VirtualInst known = inst;
  for (size_t k = 1; k < known.operands.size(); ++k) {
    const auto value = is_register(known.operands[k]) ? values_.find(known.operands[k].reg) : values_.end();
    if (value != values_.end()) known.operands[k] = VirtualOperand::value(value->second);
  }
  const std::optional<uint64_t> found = starts_.empty() ? std::nullopt : constants_.value_of(known);
  const bool is_known = found.has_value();
  const uint64_t value = found.value_or(0);
  if (is_known) inst = constant_move(inst.operands[0].reg, value, inst.line);
  for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
    VirtualOperand& o = inst.operands[slot];
    if (!isa::is_destination(kind) || !is_register(o)) return;
    if (last && keeps(o.reg)) {
      names_.erase(o.reg);
      return;
    }
    const VirtualRegister fresh = program_.new_register(program_.registers[o.reg]);
    names_[o.reg] = fresh;
    o = VirtualOperand::of(fresh);
    if (is_known) values_[fresh] = value;
  });
}

// Rewrites a sum of a stepping register and a constant one as the first turn's sum plus the steps since then.
bool LoopBody::take_from_first(VirtualInst& inst, int64_t turn, size_t i) const {
  const bool wide = inst.op == ops_.add_s64 || inst.op == ops_.add_u64;
  if (turn == 0 || (!wide && inst.op != ops_.add_s32 && inst.op != ops_.add_u32) ||
      keeps(inst.operands[0].reg))
    return false;
  for (size_t k : {size_t{1}, size_t{2}}) {
    const VirtualOperand &moving = inst.operands[k], &other = inst.operands[3 - k];
    if (!is_register(moving) || !steps_.contains(moving.reg) || !is_register(other) || writes(other.reg) ||
        starts_.contains(moving.reg))
      continue;
    // The first turn and this turn must both read the register before its step, or both after it.
    const int64_t behind = stepped_.contains(moving.reg) && stepped_.at(moving.reg) > turn;
    if (behind != int64_t{is_behind(i, moving.reg)}) return false;
    inst.operands = {inst.operands[0], first_.at(i), constant_of(turn * steps_.at(moving.reg), wide)};
    return true;
  }
  return false;
}

bool LoopBody::is_behind(size_t i, VirtualRegister r) const {
  const std::vector<VirtualInst>& code = block().code;
  return std::any_of(code.begin(), code.begin() + std::ptrdiff_t(i),
                     [&](const VirtualInst& inst) { return step_of(inst) && inst.operands[0].reg == r; });
}

}  // namespace glint::frontend::ptx
