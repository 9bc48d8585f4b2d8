// Copies loop bodies with registers of their own.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/unroll.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "frontend/backend/slots.h"
#include "frontend/backend/slow_paths.h"

namespace glint::frontend::ptx {
namespace {

constexpr int64_t kTurns = 4;  // turns unrolled at a time; of the rest, two at a time
// Limits the instructions of a body. Choice: with 64, the counts of the calibration kernels, in which all
// lanes count alike, match an H200. In kernels whose lanes may count differently, the H200's compiler has
// copied a body of 20 instructions and left one of 45 alone (h_spmv, h_chase of bench/held_out).
constexpr size_t kMostCode = 64, kMostCodeOfEach = 32;

// Handles one loop: its block, and the registers of its copies.
class CountedLoop {
 public:
  CountedLoop(Draft& draft, VirtualProgram& program, BlockId at)
      : draft_(draft), program_(program), at_(at) {}

  bool run() {
    const DraftBlock& block = draft_.blocks[at_];
    if (block.end != DraftBlock::End::Branch || block.taken != at_ || block.next == at_ || block.negate ||
        block.code.size() > kMostCode)
      return false;
    const auto all = [&](bool (*holds)(const VirtualInst&)) {
      return std::all_of(block.code.begin(), block.code.end(), holds);
    };
    if (!all(can_be_copied)) return false;
    find_definitions(block);
    if (!find_counter(block)) return false;
    const bool needs_together = !all(is_a_lane_s_own) || block.code.size() > kMostCodeOfEach;
    if (needs_together && !lanes_count_together()) return false;
    append();
    return true;
  }

 private:
  static bool can_be_copied(const VirtualInst& inst) {
    return is_real(inst) && !is_guarded(inst) && !has_slow_path(inst.op) &&
           isa::effect_row(row_of(inst).effect).freedom.may_copy;
  }
  // Returns false for instructions that involve other lanes. Unrolling could separate lanes of a warp that
  // were in one turn into different copies.
  static bool is_a_lane_s_own(const VirtualInst& inst) {
    return is_pure(inst) && row_of(inst).unit != isa::Unit::Shuffle && row_of(inst).name != "activemask.b32";
  }

  void find_definitions(const DraftBlock& block) {
    for (const VirtualInst& inst : block.code)
      for_each_def(inst, [&](VirtualRegister r) { ++definitions_[r]; });
    std::set<VirtualRegister> written;
    for (const VirtualInst& inst : block.code) {
      for_each_use(inst, [&](VirtualRegister r) {
        if (definitions_.contains(r) && !written.contains(r)) kept_.insert(r);
      });
      for_each_def(inst, [&](VirtualRegister r) { written.insert(r); });
      if (const auto step = step_of(inst)) steps_[inst.operands[0].reg] = *step;
    }
    for (BlockId b = 0; b < draft_.blocks.size(); ++b) {
      if (b == at_) continue;
      for (const VirtualInst& inst : draft_.blocks[b].code)
        for_each_use(inst, [&](VirtualRegister r) {
          if (definitions_.contains(r)) kept_.insert(r);
        });
      if (definitions_.contains(draft_.blocks[b].condition)) kept_.insert(draft_.blocks[b].condition);
    }
  }

  // Returns the constant that the instruction adds to a register which nothing else changes.
  std::optional<int64_t> step_of(const VirtualInst& inst) const {
    const bool narrow = inst.op == ops_.add_s32 || inst.op == ops_.add_u32,
               wide = inst.op == ops_.add_s64 || inst.op == ops_.add_u64;
    if (!narrow && !wide) return std::nullopt;
    const VirtualOperand &to = inst.operands[0], &from = inst.operands[1], &by = inst.operands[2];
    if (!is_register(from) || from.reg != to.reg || !is_constant(by) || definitions_.at(to.reg) != 1)
      return std::nullopt;
    const int64_t step = narrow ? int64_t{int32_t(uint32_t(by.constant))} : int64_t(by.constant);
    constexpr int64_t kMost = 1 << 24;
    return step > -kMost && step < kMost ? std::optional(step) : std::nullopt;
  }

  // Finds the counter in the last test: `setp.ne.s32 p, r, 0` after r was decremented, or `setp.lt.s32 p, r,
  // bound` after r was incremented.
  bool find_counter(const DraftBlock& block) {
    if (block.code.empty() || kept_.contains(block.condition)) return false;
    const VirtualInst& test = block.code.back();
    if ((test.op != setp_ne_s32_ && test.op != setp_lt_s32_) || test.operands[0].reg != block.condition ||
        definitions_[block.condition] != 1)
      return false;
    const VirtualOperand &value = test.operands[1], &end = test.operands[2];
    if (!is_register(value) || !steps_.contains(value.reg) ||
        program_.registers[value.reg] != RegisterClass::B32)
      return false;
    counter_ = value.reg;
    end_ = end;
    counts_up_ = test.op == setp_lt_s32_;
    if (counts_up_)
      return steps_[counter_] > 0 &&
             (is_constant(end) || (is_register(end) && !definitions_.contains(end.reg)));
    return steps_[counter_] < 0 && is_constant(end) && end.constant == 0;
  }

  // Returns true when all lanes in the loop are in the same turn and leave the loop together.
  bool lanes_count_together() const {
    return is_uniform(VirtualOperand::of(counter_), true) && is_uniform(end_, false);
  }
  // Returns true when the operand has one value for all lanes: it is a constant, is computed once from such
  // operands, or is the counter and starts with such a value.
  bool is_uniform(const VirtualOperand& o, bool is_counter, int depth = 0) const {
    constexpr int kDeepest = 8;
    if (is_constant(o)) return true;
    if (o.kind == VirtualOperand::Kind::Special)
      return o.special >= isa::Special::NtidX && o.special <= isa::Special::NctaidZ;
    if (!is_register(o) || depth == kDeepest) return false;
    const VirtualInst* source = nullptr;
    for (BlockId b = 0; b < draft_.blocks.size(); ++b)
      for (const VirtualInst& inst : draft_.blocks[b].code) {
        bool writes = false;
        for_each_def(inst, [&](VirtualRegister r) { writes |= r == o.reg; });
        if (!writes || (is_counter && b == at_)) continue;
        if (source || is_guarded(inst)) return false;
        source = &inst;
      }
    if (!source) return false;
    const isa::OpRow& row = row_of(*source);
    const bool reads_constants =
        row.memory.space == isa::Space::Const || row.memory.space == isa::Space::Param;
    if (row.effect != isa::Effect::None && !reads_constants) return false;
    if (row.unit == isa::Unit::Shuffle || row.name == "activemask.b32") return false;
    bool uniform = true;
    for_each_slot(row, [&](size_t slot, isa::OperandKind kind) {
      if (!isa::is_destination(kind))
        uniform = uniform && is_uniform(source->operands[slot], false, depth + 1);
    });
    return uniform;
  }

  static VirtualOperand constant_of(int64_t value, bool wide) {
    return VirtualOperand::value(wide ? uint64_t(value) : uint64_t(uint32_t(value)));
  }
  bool is_wide(VirtualRegister r) const { return program_.registers[r] == RegisterClass::B64; }
  VirtualOperand now(const VirtualOperand& o) const {
    if (!is_register(o)) return o;
    const auto found = names_.find(o.reg);
    return found == names_.end() ? o : VirtualOperand::of(found->second);
  }

  void copy_body(int64_t turn, bool last, std::vector<VirtualInst>& out) {
    const std::vector<VirtualInst> code = draft_.blocks[at_].code;
    for (size_t i = 0; i + 1 < code.size(); ++i) {  // leaves out the test
      VirtualInst inst = code[i];
      if (const auto step = step_of(inst)) {
        const VirtualRegister from = inst.operands[0].reg;
        inst.operands[2] = constant_of((turn + 1) * *step, is_wide(from));
        stepped_[from] = turn + 1;
      } else if (!take_from_first(inst, turn, i)) {
        for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
          if (!isa::is_destination(kind)) inst.operands[slot] = now(inst.operands[slot]);
        });
      }
      std::vector<VirtualRegister> to;
      for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
        VirtualOperand& o = inst.operands[slot];
        if (!isa::is_destination(kind) || !is_register(o)) return;
        if (last && kept_.contains(o.reg)) {
          names_.erase(o.reg);
          return;
        }
        const VirtualRegister fresh = program_.new_register(program_.registers[o.reg]);
        names_[o.reg] = fresh;
        o = VirtualOperand::of(fresh);
      });
      if (turn == 0 && !inst.operands.empty()) first_[i] = inst.operands[0];
      out.push_back(std::move(inst));
    }
  }

  // Rewrites a sum of a stepping register and a constant one as the first turn's sum plus the steps since
  // then.
  bool take_from_first(VirtualInst& inst, int64_t turn, size_t i) const {
    const bool wide = inst.op == ops_.add_s64 || inst.op == ops_.add_u64;
    if (turn == 0 || (!wide && inst.op != ops_.add_s32 && inst.op != ops_.add_u32) ||
        kept_.contains(inst.operands[0].reg))
      return false;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualOperand &moving = inst.operands[k], &other = inst.operands[3 - k];
      if (!is_register(moving) || !steps_.contains(moving.reg) || !is_register(other) ||
          definitions_.contains(other.reg))
        continue;
      // The first turn and this turn must both read the register before its step, or both after it.
      const int64_t behind = stepped_.contains(moving.reg) && stepped_.at(moving.reg) > turn;
      if (behind != int64_t{is_behind(i, moving.reg)}) return false;
      inst.operands = {inst.operands[0], first_.at(i), constant_of(turn * steps_.at(moving.reg), wide)};
      return true;
    }
    return false;
  }
  bool is_behind(size_t i, VirtualRegister r) const {
    const std::vector<VirtualInst>& code = draft_.blocks[at_].code;
    return std::any_of(code.begin(), code.begin() + std::ptrdiff_t(i),
                       [&](const VirtualInst& inst) { return step_of(inst) && inst.operands[0].reg == r; });
  }

  BlockId add_block(std::vector<VirtualInst> code, BlockId next) {
    DraftBlock block;
    block.name = draft_.blocks[at_].name + "_by_" + std::to_string(draft_.blocks.size() - first_block_);
    block.line = draft_.blocks[at_].line;
    block.code = std::move(code);
    block.end = DraftBlock::End::Goto;
    block.next = next;
    draft_.blocks.push_back(std::move(block));
    layout_.push_back(BlockId(draft_.blocks.size() - 1));
    return layout_.back();
  }
  // Ends a block with a test. It goes to `taken` when the counter lasts for `turns` more turns or, with
  // `negate`, when it does not.
  void end_in_test(BlockId at, int64_t turns, bool negate, BlockId taken) {
    DraftBlock& block = draft_.blocks[at];
    block.end = DraftBlock::End::Branch;
    block.condition = program_.new_register(RegisterClass::Predicate);
    const uint16_t op = counts_up_ ? setp_lt_s32_ : turns > 1 ? setp_gt_s32_ : setp_ne_s32_;
    block.code.push_back(make_inst(
        op, {VirtualOperand::of(block.condition), VirtualOperand::of(counter_), limit(turns)}, block.line));
    block.negate = negate;
    block.taken = taken;
  }
  // Returns the bound that the counter must not have reached if it is to last for `turns` turns. The
  // subtraction saturates, so that no counter can be below the lowest bound.
  VirtualOperand limit(int64_t turns) {
    const int64_t way = steps_[counter_] * (turns - 1);
    if (!counts_up_) return constant_of(-way, false);
    if (turns == 1) return end_;
    if (is_constant(end_))
      return constant_of(std::max<int64_t>(int64_t{int32_t(uint32_t(end_.constant))} - way, INT32_MIN),
                         false);
    const auto [found, is_new] = limits_.try_emplace(turns, kNoRegister);
    if (is_new) {
      found->second = program_.new_register(RegisterClass::B32);
      std::vector<VirtualInst>& code = draft_.blocks[first_block_].code;
      code.insert(code.begin(),
                  make_inst(sub_sat_s32_, {VirtualOperand::of(found->second), end_, constant_of(way, false)},
                            draft_.blocks[at_].line));
    }
    return VirtualOperand::of(found->second);
  }

  // Appends copies of the body as one block, whose loads the scheduler may issue together. Returns the block.
  // It goes to `next`, or to the block that follows it.
  BlockId add_turns(int64_t turns, BlockId next = kNoBlock) {
    stepped_.clear(), names_.clear(), first_.clear();
    std::vector<VirtualInst> code;
    for (int64_t turn = 0; turn < turns; ++turn) copy_body(turn, turn + 1 == turns, code);
    return add_block(std::move(code), next != kNoBlock ? next : BlockId(draft_.blocks.size()) + 1);
  }

  // Puts the copies before the loop, with tests around them: first copies of four turns, then of two, then
  // the loop itself. The first turn runs whatever the counter is.
  void append() {
    first_block_ = BlockId(draft_.blocks.size());
    const BlockId entry = add_block({}, first_block_ + 1);
    const BlockId fours = add_turns(kTurns), few = add_block({}, kNoBlock), two = add_turns(2),
                  rest = add_block({}, at_), short_entry = add_block({}, at_);
    draft_.blocks[few].next = two;
    end_in_test(entry, kTurns, true, short_entry);
    end_in_test(few - 1, kTurns, false, fours);
    end_in_test(few, 2, true, rest);
    end_in_test(rest, 1, true, draft_.blocks[at_].next);
    end_in_test(short_entry, 2, false, two);
    for (BlockId b = 0; b < first_block_; ++b) {
      DraftBlock& block = draft_.blocks[b];
      if (b == at_ || block.end == DraftBlock::End::Exit) continue;
      if (block.next == at_) block.next = first_block_;
      if (block.end == DraftBlock::End::Branch && block.taken == at_) block.taken = first_block_;
    }
    draft_.layout.insert(std::find(draft_.layout.begin(), draft_.layout.end(), at_), layout_.begin(),
                         layout_.end());
  }

  Draft& draft_;
  VirtualProgram& program_;
  const BlockId at_;
  const Ops ops_;
  const uint16_t setp_ne_s32_ = isa::op_index("setp.ne.s32"), setp_gt_s32_ = isa::op_index("setp.gt.s32");
  const uint16_t setp_lt_s32_ = isa::op_index("setp.lt.s32"), sub_sat_s32_ = isa::op_index("sub.sat.s32");
  VirtualRegister counter_ = kNoRegister;
  VirtualOperand end_;  // bound of the counter
  bool counts_up_ = false;
  std::map<int64_t, VirtualRegister> limits_;   // by number of turns, if the bound is in a register
  std::map<VirtualRegister, int> definitions_;  // number of definitions in the loop, by register
  // Holds the defined registers that the next turn or other blocks read.
  std::set<VirtualRegister> kept_;
  std::map<VirtualRegister, int64_t> steps_;          // constant that a turn adds
  std::map<VirtualRegister, int64_t> stepped_;        // turns that the copies so far have done
  std::map<VirtualRegister, VirtualRegister> names_;  // present name in the copies
  std::map<size_t, VirtualOperand> first_;            // result of each instruction in the first turn
  BlockId first_block_ = kNoBlock;                    // first of the new blocks
  std::vector<BlockId> layout_;                       // the new blocks, in order
};

}  // namespace

void unroll_loops(Draft& draft, VirtualProgram& program) {
  const std::vector<BlockId> layout = draft.layout;
  for (BlockId b : layout) CountedLoop(draft, program, b).run();
}

}  // namespace glint::frontend::ptx
