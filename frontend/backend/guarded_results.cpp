// Moves the definition of a selected value to the place of its selection.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/guarded_results.h"

#include <optional>
#include <utility>
#include <vector>

#include "frontend/backend/def_use.h"
#include "frontend/backend/slow_paths.h"
#include "frontend/backend/unchanged.h"

namespace glint::frontend {
namespace {

class Guarding {
 public:
  Guarding(VirtualProgram& program, const Ops& ops) : program_(program), ops_(ops), registers_(program) {}

  void run() {
    // Definitions are known by their addresses, so that no block's code is replaced before all are done.
    std::vector<std::vector<VirtualInst>> changed;
    for (VirtualBlock& block : program_.blocks) changed.push_back(run(block));
    for (size_t b = 0; b < changed.size(); ++b) program_.blocks[b].code = std::move(changed[b]);
  }

 private:
  std::vector<VirtualInst> run(VirtualBlock& block) {
    block_ = &block;
    gone_.assign(block.code.size(), false);
    std::vector<std::optional<VirtualInst>> moves(block.code.size());
    for (size_t i = 0; i < block.code.size(); ++i) moves[i] = guard(block.code[i]);
    std::vector<VirtualInst> code;
    for (size_t i = 0; i < block.code.size(); ++i) {
      if (moves[i]) code.push_back(std::move(*moves[i]));
      if (!gone_[i]) code.push_back(block.code[i]);
    }
    return code;
  }

  // Rewrites a selection if that is possible. Returns the move that must then stand before it.
  std::optional<VirtualInst> guard(VirtualInst& inst) {
    if (!is_real(inst) || is_guarded(inst) || (inst.op != ops_.selp_b32 && inst.op != ops_.selp_b64))
      return {};
    const VirtualOperand result = inst.operands[0], condition = inst.operands[3];
    if (!is_register(condition) || !is_register(result)) return {};
    for (size_t k : {size_t{1}, size_t{2}}) {
      VirtualInst* source = definition_to_move(inst.operands[k], inst);
      const VirtualOperand other = inst.operands[3 - k];
      if (!source || !is_register(other)) continue;
      const bool is_result = other.reg == result.reg;
      // The move that comes before the instruction must not write what the instruction reads.
      // The instruction may read the other side, too: it then reads the result, which holds the same.
      const uint32_t reads_of_other = is_register(other) && reads(*source, other.reg) ? 1 : 0;
      if (!is_result && (!registers_.definition(other) || registers_.uses[other.reg] != 1 + reads_of_other ||
                         reads(*source, result.reg)))
        continue;
      VirtualInst moved = *source;
      if (!is_result && reads_of_other != 0)
        for_each_slot(row_of(moved), [&](size_t slot, isa::OperandKind kind) {
          VirtualOperand& o = moved.operands[slot];
          if (!isa::is_destination(kind) && is_register(o) && o.reg == other.reg) o.reg = result.reg;
        });
      gone_[size_t(source - block_->code.data())] = true;
      moved.operands[0] = result;
      moved.guard = condition.reg;
      moved.guard_negate = k == 2;
      const VirtualInst move =
          make_inst(inst.op == ops_.selp_b64 ? ops_.mov_b64 : ops_.mov_b32, {result, other}, inst.line);
      inst = std::move(moved);
      return is_result ? std::nullopt : std::optional(move);
    }
    return {};
  }

  // Returns the instruction of the block that computes the operand for the selection alone, if its sources
  // still hold the same values there and it reads no memory and no other lanes.
  VirtualInst* definition_to_move(const VirtualOperand& o, const VirtualInst& selection) const {
    VirtualInst* source = registers_.definition(o);
    if (!source || !registers_.is_used_once(o) || !is_pure(*source) || has_slow_path(source->op))
      return nullptr;
    const VirtualInst *first = block_->code.data(), *last = first + block_->code.size();
    if (source < first || source >= last || source >= &selection) return nullptr;
    const isa::OpRow& row = row_of(*source);
    if (gone_[size_t(source - first)] || isa::depends_on_lanes(row)) return nullptr;
    if (row.unit == isa::Unit::Lsu || ops_.is_move(source->op)) return nullptr;
    int destinations = 0;
    bool is_same = true;
    for_each_slot(row, [&](size_t slot, isa::OperandKind kind) {
      if (isa::is_destination(kind))
        ++destinations;
      else
        is_same = is_same && is_unchanged(registers_, *block_, source->operands[slot], *source, selection);
    });
    return destinations == 1 && is_same ? source : nullptr;
  }

  VirtualProgram& program_;
  const Ops& ops_;
  DefUse registers_;
  const VirtualBlock* block_ = nullptr;  // the block that the pass is in
  std::vector<bool> gone_;               // of its instructions: those that moved to their selections
};

}  // namespace

void guard_selected_results(VirtualProgram& program, const Ops& ops) {
  Guarding(program, ops).run();
}

}  // namespace glint::frontend
