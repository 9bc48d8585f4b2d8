// Copies loop bodies with registers of their own.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/unroll.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "frontend/backend/slow_paths.h"
#include "frontend/ptx/early_exits.h"
#include "frontend/ptx/loop_body.h"
#include "frontend/ptx/loop_counter.h"

namespace glint::frontend::ptx {
namespace {

constexpr int64_t kTurns = 4;  // turns unrolled at a time; of the rest, two at a time

// Limits what is unrolled. Source: loops of fused multiply-adds, integer ops, and loads from global and
// shared memory, with constant and unknown numbers of turns, through the assembler of CUDA 13.0 for sm_90.
// The numbers are the largest bodies of which it made copies; a load counts twice there. Without loads it
// copies short bodies only. Choice: a body with a barrier may have 64, because the assembler copies one of 46
// (k_matmul_tiled of the calibration kernels).
constexpr size_t kMostWithoutLoads = 18, kMoreForSharedLoad = 5, kMoreForLoad = 26, kMostOfUnknown = 44;
constexpr size_t kMostOfKnown = 64;  // where the number of turns is constant, but too large for one run
constexpr size_t kMostWithBarrier = 64;
constexpr int64_t kMostWhole = 1024;
// Returns the largest number of instructions that all turns of a loop together may have to become one run.
constexpr double most_of_whole(int64_t turns) {
  constexpr double kLeast = 384, kMoreForTurn = 13.2;
  return std::min(double(kMostWhole), kLeast + kMoreForTurn * double(std::max<int64_t>(turns - 3, 0)));
}

// Handles one loop: its block, and the registers of its copies.
class CountedLoop {
 public:
  CountedLoop(Draft& draft, VirtualProgram& program, BlockId at)
      : draft_(draft),
        program_(program),
        at_(at),
        body_(draft, program, at),
        count_(draft, program, body_, at) {}

  bool run() {
    const DraftBlock& block = draft_.blocks[at_];
    if (block.end != DraftBlock::End::Branch || block.taken != at_ || block.next == at_ || block.negate ||
        block.code.empty() || !block.may_unroll)
      return false;
    const auto all = [&](bool (*holds)(const VirtualInst&)) {
      return std::all_of(block.code.begin(), block.code.end(), holds);
    };
    if (!all(can_be_copied)) return false;
    if (block.code.back().op == and_pred_)
      return all(is_no_barrier) && unroll_with_exits(draft_, program_, at_, body_, count_);
    if (!count_.find(block.code.back()) || block.code.back().operands[0].reg != block.condition) return false;
    test_ = is_wide() ? &tests_of_pairs_ : &tests_of_words_;
    is_unsigned_ = block.code.back().op == test_->lt_unsigned;
    // A load of one value counts twice, and one of a vector once.
    const bool waits = !all(is_no_barrier);
    const size_t size =
        size_t(std::count_if(block.code.begin(), block.code.end() - 1,
                             [&](const VirtualInst& inst) { return !count_.vanishes(inst); })) +
        (waits ? 0 : loads(isa::Space::Global, true) + loads(isa::Space::Shared, true));
    const std::optional<int64_t> turns = count_.known_turns(block.code.back());
    if (turns && double(*turns * int64_t(size)) < most_of_whole(*turns)) {
      become_whole(*turns);
      return true;
    }
    if (!counts_to_end(block.code.back()) || size > (turns   ? kMostOfKnown
                                                     : waits ? kMostWithBarrier
                                                             : most_of_unknown()))
      return false;
    if (!all(is_a_lane_s_own) && !lanes_count_together()) return false;
    append();
    return true;
  }

 private:
  static bool can_be_copied(const VirtualInst& inst) {
    return is_real(inst) && !is_guarded(inst) && !has_slow_path(inst.op) &&
           isa::effect_row(row_of(inst).effect).freedom.may_copy;
  }
  static bool is_no_barrier(const VirtualInst& inst) { return row_of(inst).effect != isa::Effect::Barrier; }
  // Returns false for instructions that involve other lanes. Unrolling could separate lanes of a warp that
  // were in one turn into different copies.
  static bool is_a_lane_s_own(const VirtualInst& inst) {
    return is_pure(inst) && !isa::depends_on_lanes(row_of(inst));
  }

  size_t loads(isa::Space space, bool of_one_value = false) const {
    const std::vector<VirtualInst>& code = draft_.blocks[at_].code;
    return size_t(std::count_if(code.begin(), code.end(), [&](const VirtualInst& inst) {
      return row_of(inst).memory.space == space && row_of(inst).unit == isa::Unit::Lsu &&
             (!of_one_value || inst.operands.size() == 2);
    }));
  }
  size_t most_of_unknown() const {
    return std::min(kMostOfUnknown, kMostWithoutLoads + kMoreForSharedLoad * loads(isa::Space::Shared) +
                                        kMoreForLoad * loads(isa::Space::Global));
  }

  // Returns true for `setp.ne p, r, 0` after r was decremented, and for `setp.lt p, r, bound` after r was
  // incremented.
  bool counts_to_end(const VirtualInst& test) {
    counts_up_ = test.op == test_->lt || is_unsigned_;
    if (counts_up_) return *body_.step(count_.counter()) > 0;
    return test.op == test_->ne && *body_.step(count_.counter()) < 0 && is_constant(count_.end()) &&
           count_.end().constant == 0;
  }

  // Puts all turns in place of the loop. The registers that step are constants where they start as constants.
  void become_whole(int64_t turns) {
    std::vector<VirtualInst> code;
    body_.begin_copies();
    for (VirtualRegister r = 0, end = VirtualRegister(program_.registers.size()); r < end; ++r)
      if (const auto start = body_.step(r) ? count_.start_of(r) : std::nullopt)
        body_.starts_with(r, *start, code);
    for (int64_t turn = 0; turn < turns; ++turn) body_.copy(turn, turn + 1 == turns, code);
    DraftBlock& block = draft_.blocks[at_];
    block.code = std::move(code);
    block.end = DraftBlock::End::Goto;
    block.condition = kNoRegister;
    block.taken = kNoBlock;
  }

  // Returns true when all lanes in the loop are in the same turn and leave the loop together.
  bool lanes_count_together() const {
    return is_uniform(VirtualOperand::of(count_.counter()), true) && is_uniform(count_.end(), false);
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
    if (isa::depends_on_lanes(row)) return false;
    bool uniform = true;
    for_each_slot(row, [&](size_t slot, isa::OperandKind kind) {
      if (!isa::is_destination(kind))
        uniform = uniform && is_uniform(source->operands[slot], false, depth + 1);
    });
    return uniform;
  }

  bool is_wide() const { return count_.is_wide(); }
  VirtualOperand number(int64_t value) const {
    return VirtualOperand::value(is_wide() ? uint64_t(value) : uint64_t(uint32_t(value)));
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
    const uint16_t op = is_unsigned_ ? test_->lt_unsigned
                        : counts_up_ ? test_->lt
                        : turns > 1  ? test_->gt
                                     : test_->ne;
    block.code.push_back(make_inst(
        op, {VirtualOperand::of(block.condition), VirtualOperand::of(count_.counter()), limit(turns)},
        block.line));
    block.negate = negate;
    block.taken = taken;
  }
  // Returns the bound that the counter must not have reached if it is to last for `turns` turns. The
  // subtraction saturates, so that no counter can be below the lowest bound.
  VirtualOperand limit(int64_t turns) {
    const int64_t way = *body_.step(count_.counter()) * (turns - 1);
    if (!counts_up_) return number(-way);
    if (turns == 1) return count_.end();
    const int64_t least = is_unsigned_ ? 0 : is_wide() ? INT64_MIN : INT32_MIN;
    const auto reduced = [&](int64_t end) { return end < least + way ? least : end - way; };
    if (is_constant(count_.end())) {
      const uint64_t end = count_.end().constant;
      if (is_unsigned_) return number(int64_t(end < uint64_t(way) ? 0 : end - uint64_t(way)));
      return number(reduced(is_wide() ? int64_t(end) : int64_t{int32_t(uint32_t(end))}));
    }
    const auto [found, is_new] = limits_.try_emplace(turns, kNoRegister);
    if (is_new) {
      found->second = program_.new_register(program_.registers[count_.counter()]);
      const VirtualOperand to = VirtualOperand::of(found->second);
      const isa::Line& line = draft_.blocks[at_].line;
      std::vector<VirtualInst> code;
      if (is_wide() || is_unsigned_) {
        code.push_back(make_inst(is_unsigned_ ? test_->max_unsigned : max_s64_,
                                 {to, count_.end(), number(least + way)}, line));
        code.push_back(make_inst(is_wide() ? sub_s64_ : sub_s32_, {to, to, number(way)}, line));
      } else {
        code.push_back(make_inst(sub_sat_s32_, {to, count_.end(), number(way)}, line));
      }
      std::vector<VirtualInst>& first = draft_.blocks[first_block_].code;
      first.insert(first.begin(), code.begin(), code.end());
    }
    return VirtualOperand::of(found->second);
  }

  // Appends copies of the body as one block, whose loads the scheduler may issue together. Returns the block.
  // It goes to `next`, or to the block that follows it.
  BlockId add_turns(int64_t turns, BlockId next = kNoBlock) {
    std::vector<VirtualInst> code;
    body_.begin_copies();
    for (int64_t turn = 0; turn < turns; ++turn) body_.copy(turn, turn + 1 == turns, code);
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
  LoopBody body_;
  LoopCounter count_;
  const Ops ops_;
  // Names the tests of a counter, and the op that bounds of unsigned tests need.
  struct Tests {
    uint16_t ne, gt, lt, lt_unsigned, max_unsigned;
  };
  const Tests tests_of_words_ = {isa::op_index("setp.ne.s32"), isa::op_index("setp.gt.s32"),
                                 isa::op_index("setp.lt.s32"), isa::op_index("setp.lt.u32"),
                                 isa::op_index("max.u32")};
  const Tests tests_of_pairs_ = {isa::op_index("setp.ne.s64"), isa::op_index("setp.gt.s64"),
                                 isa::op_index("setp.lt.s64"), isa::op_index("setp.lt.u64"),
                                 isa::op_index("max.u64")};
  const uint16_t sub_sat_s32_ = isa::op_index("sub.sat.s32"), sub_s32_ = isa::op_index("sub.s32"),
                 sub_s64_ = isa::op_index("sub.s64"), max_s64_ = isa::op_index("max.s64");
  const Tests* test_ = &tests_of_words_;
  const uint16_t and_pred_ = isa::op_index("and.pred");
  bool counts_up_ = false, is_unsigned_ = false;
  std::map<int64_t, VirtualRegister> limits_;  // by number of turns, if the bound is in a register
  BlockId first_block_ = kNoBlock;             // first of the new blocks
  std::vector<BlockId> layout_;                // the new blocks, in order
};

}  // namespace

void unroll_loops(Draft& draft, VirtualProgram& program) {
  const std::vector<BlockId> layout = draft.layout;
  for (BlockId b : layout) CountedLoop(draft, program, b).run();
}

}  // namespace glint::frontend::ptx
