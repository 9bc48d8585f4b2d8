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
#include "frontend/ptx/constant_words.h"
#include "frontend/ptx/loop_body.h"

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
constexpr int64_t kMostTurns = 256, kMostWhole = 1024;
// Returns the largest number of instructions that all turns of a loop together may have to become one run.
constexpr double most_of_whole(int64_t turns) {
  constexpr double kLeast = 384, kMoreForTurn = 13.2;
  return std::min(double(kMostWhole), kLeast + kMoreForTurn * double(std::max<int64_t>(turns - 3, 0)));
}

// Handles one loop: its block, and the registers of its copies.
class CountedLoop {
 public:
  CountedLoop(Draft& draft, VirtualProgram& program, BlockId at)
      : draft_(draft), program_(program), at_(at), body_(draft, program, at) {}

  bool run() {
    const DraftBlock& block = draft_.blocks[at_];
    if (block.end != DraftBlock::End::Branch || block.taken != at_ || block.next == at_ || block.negate ||
        block.code.empty() || !block.may_unroll)
      return false;
    const auto all = [&](bool (*holds)(const VirtualInst&)) {
      return std::all_of(block.code.begin(), block.code.end(), holds);
    };
    if (!all(can_be_copied) || !find_test(block)) return false;
    // A load of one value counts twice, and one of a vector once.
    const bool waits = !all(is_no_barrier);
    const size_t size = size_t(std::count_if(block.code.begin(), block.code.end() - 1,
                                             [&](const VirtualInst& inst) { return !vanishes(inst); })) +
                        (waits ? 0 : loads(isa::Space::Global, true) + loads(isa::Space::Shared, true));
    const std::optional<int64_t> turns = known_turns(block);
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
    return is_pure(inst) && row_of(inst).unit != isa::Unit::Shuffle && row_of(inst).name != "activemask.b32";
  }

  size_t loads(isa::Space space, bool of_one_value = false) const {
    const std::vector<VirtualInst>& code = draft_.blocks[at_].code;
    return size_t(std::count_if(code.begin(), code.end(), [&](const VirtualInst& inst) {
      return row_of(inst).memory.space == space && row_of(inst).unit == isa::Unit::Lsu &&
             (!of_one_value || inst.operands.size() == 2);
    }));
  }
  // Returns true for a sum of a constant and a register that steps: displacements and constants take its
  // place.
  bool vanishes(const VirtualInst& inst) const {
    if (inst.op != ops_.add_s32 && inst.op != ops_.add_u32 && inst.op != ops_.add_s64 &&
        inst.op != ops_.add_u64)
      return false;
    return is_register(inst.operands[1]) && body_.step(inst.operands[1].reg) && is_constant(inst.operands[2]);
  }
  size_t most_of_unknown() const {
    return std::min(kMostOfUnknown, kMostWithoutLoads + kMoreForSharedLoad * loads(isa::Space::Shared) +
                                        kMoreForLoad * loads(isa::Space::Global));
  }

  // Finds the counter, which steps by a constant, in the last test.
  bool find_test(const DraftBlock& block) {
    const VirtualInst& test = block.code.back();
    if (body_.keeps(block.condition) || !row_of(test).name.starts_with("setp.") ||
        test.operands.size() != 3 || test.operands[0].reg != block.condition ||
        !body_.writes_once(block.condition))
      return false;
    const VirtualOperand& value = test.operands[1];
    if (!is_register(value) || !body_.step(value.reg) || program_.registers[value.reg] != RegisterClass::B32)
      return false;
    counter_ = value.reg;
    end_ = test.operands[2];
    return is_constant(end_) || (is_register(end_) && !body_.writes(end_.reg));
  }
  // Returns true for `setp.ne.s32 p, r, 0` after r was decremented, and for `setp.lt.s32 p, r, bound` after r
  // was incremented.
  bool counts_to_end(const VirtualInst& test) {
    counts_up_ = test.op == setp_lt_s32_;
    if (counts_up_) return *body_.step(counter_) > 0;
    return test.op == setp_ne_s32_ && *body_.step(counter_) < 0 && is_constant(end_) && end_.constant == 0;
  }

  // Returns the constant that the register holds when the loop begins, if one block leads to the loop, and it
  // or the blocks that alone lead to it set the register.
  std::optional<uint64_t> start_of(VirtualRegister r) const {
    BlockId b = at_;
    for (size_t hops = 0; hops < draft_.blocks.size(); ++hops) {
      BlockId before = kNoBlock;
      for (BlockId p = 0; p < draft_.blocks.size(); ++p) {
        const std::vector<BlockId> next = draft_.blocks[p].successors();
        if (p == at_ || std::find(next.begin(), next.end(), b) == next.end()) continue;
        if (before != kNoBlock) return {};
        before = p;
      }
      if (before == kNoBlock) return {};
      b = before;
      const std::vector<VirtualInst>& code = draft_.blocks[b].code;
      for (size_t i = code.size(); i-- > 0;) {
        bool writes = false;
        for_each_def(code[i], [&](VirtualRegister written) { writes |= written == r; });
        if (!writes) continue;
        return ConstantWords().value_of(code[i]);
      }
    }
    return {};
  }

  // Returns the number of turns if it is a constant of at most kMostTurns.
  std::optional<int64_t> known_turns(const DraftBlock& block) const {
    const std::optional<uint64_t> start = start_of(counter_);
    if (!start || !is_constant(end_)) return {};
    const std::string_view test = row_of(block.code.back()).name;
    const bool is_signed = test.ends_with(".s32");
    if (!is_signed && !test.ends_with(".u32")) return {};
    const auto extended = [&](uint64_t x) {
      return is_signed ? int64_t{int32_t(uint32_t(x))} : int64_t{uint32_t(x)};
    };
    const int64_t end = extended(end_.constant);
    for (int64_t turns = 1; turns <= kMostTurns; ++turns) {
      const int64_t value = extended(*start + uint64_t(turns * *body_.step(counter_)));
      const std::string_view relation = test.substr(5, 3);
      if (relation == "ne."   ? value == end
          : relation == "eq." ? value != end
          : relation == "lt." ? value >= end
          : relation == "le." ? value > end
          : relation == "gt." ? value <= end
          : relation == "ge." ? value < end
                              : false)
        return turns;
    }
    return {};
  }

  // Puts all turns in place of the loop. The registers that step are constants where they start as constants.
  void become_whole(int64_t turns) {
    std::vector<VirtualInst> code;
    body_.begin_copies();
    for (VirtualRegister r = 0, end = VirtualRegister(program_.registers.size()); r < end; ++r)
      if (const auto start = body_.step(r) ? start_of(r) : std::nullopt) body_.starts_with(r, *start, code);
    for (int64_t turn = 0; turn < turns; ++turn) body_.copy(turn, turn + 1 == turns, code);
    DraftBlock& block = draft_.blocks[at_];
    block.code = std::move(code);
    block.end = DraftBlock::End::Goto;
    block.condition = kNoRegister;
    block.taken = kNoBlock;
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

  static VirtualOperand word(int64_t value) { return VirtualOperand::value(uint64_t(uint32_t(value))); }

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
    const int64_t way = *body_.step(counter_) * (turns - 1);
    if (!counts_up_) return word(-way);
    if (turns == 1) return end_;
    if (is_constant(end_))
      return word(std::max<int64_t>(int64_t{int32_t(uint32_t(end_.constant))} - way, INT32_MIN));
    const auto [found, is_new] = limits_.try_emplace(turns, kNoRegister);
    if (is_new) {
      found->second = program_.new_register(RegisterClass::B32);
      std::vector<VirtualInst>& code = draft_.blocks[first_block_].code;
      code.insert(code.begin(), make_inst(sub_sat_s32_, {VirtualOperand::of(found->second), end_, word(way)},
                                          draft_.blocks[at_].line));
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
  const Ops ops_;
  const uint16_t setp_ne_s32_ = isa::op_index("setp.ne.s32"), setp_gt_s32_ = isa::op_index("setp.gt.s32");
  const uint16_t setp_lt_s32_ = isa::op_index("setp.lt.s32"), sub_sat_s32_ = isa::op_index("sub.sat.s32");
  VirtualRegister counter_ = kNoRegister;
  VirtualOperand end_;  // bound of the counter
  bool counts_up_ = false;
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
