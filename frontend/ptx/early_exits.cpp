// Finds the test of the count beside the test of the data, and copies turns.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/early_exits.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "frontend/backend/def_use.h"

namespace glint::frontend::ptx {
namespace {

// Returns the largest number of instructions that all turns together may have. Source: loops of 1 to 96
// multiply-adds of integers with 4 to 256 turns and a test of their result, through the same assembler; the
// root was fitted to what it unrolled.
double most_with_exits(int64_t turns) {
  constexpr double kLeast = 240, kMoreForRoot = 82;
  return kLeast + kMoreForRoot * std::sqrt(double(turns));
}

class LoopWithExits {
 public:
  LoopWithExits(Draft& draft, VirtualProgram& program, BlockId at, LoopBody& body, LoopCounter& counter)
      : draft_(draft), program_(program), at_(at), body_(body), counter_(counter) {}

  bool run() {
    const std::vector<VirtualInst>& code = draft_.blocks[at_].code;
    const VirtualInst last = code.back();
    if (last.operands[0].reg != draft_.blocks[at_].condition || body_.keeps(last.operands[0].reg))
      return false;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const std::optional<size_t> test = definition_in_block(last.operands[k]),
                                  other = definition_in_block(last.operands[3 - k]);
      if (!test || !other || !counter_.find(code[*test]) || !steps_before(*test) ||
          code[*other].operands[0].reg != last.operands[3 - k].reg)
        continue;
      const auto readers = std::count_if(code.begin(), code.end(), [&](const VirtualInst& inst) {
        return reads(inst, code[*test].operands[0].reg);
      });
      const std::optional<int64_t> turns = counter_.known_turns(code[*test]);
      const auto size = std::count_if(code.begin(), code.end() - 1,
                                      [&](const VirtualInst& inst) { return !counter_.vanishes(inst); }) -
                        1;
      if (readers != 1 || !turns || double(*turns * size) >= most_with_exits(*turns)) continue;
      copy_with_exits(*turns, *other);
      return true;
    }
    return false;
  }

 private:
  // Returns the place in the block of the instruction that alone writes the register.
  std::optional<size_t> definition_in_block(const VirtualOperand& o) const {
    if (!is_register(o) || !body_.writes_once(o.reg)) return {};
    const std::vector<VirtualInst>& code = draft_.blocks[at_].code;
    for (size_t i = 0; i < code.size(); ++i) {
      bool writes = false;
      for_each_def(code[i], [&](VirtualRegister r) { writes |= r == o.reg; });
      if (writes) return i;
    }
    return {};
  }
  bool steps_before(size_t test) const {
    const std::optional<size_t> step = definition_in_block(VirtualOperand::of(counter_.counter()));
    return step && *step < test;
  }
  void copy_with_exits(int64_t turns, size_t condition) {
    std::vector<std::pair<VirtualRegister, uint64_t>> starts;
    for (VirtualRegister r = 0, end = VirtualRegister(program_.registers.size()); r < end; ++r)
      if (const auto start = body_.step(r) ? counter_.start_of(r) : std::nullopt)
        starts.emplace_back(r, *start);
    const auto first = BlockId(draft_.blocks.size());
    const BlockId exit = draft_.blocks[at_].next;
    std::vector<std::pair<std::vector<VirtualInst>, VirtualRegister>> copies;
    for (int64_t turn = 0; turn < turns; ++turn) {
      std::vector<VirtualInst> code;
      body_.begin_copies();
      for (const auto& [r, start] : starts)
        body_.starts_with(r, start + uint64_t(turn * *body_.step(r)), code);
      body_.copy(0, true, code);
      copies.emplace_back(std::move(code), body_.first_result(condition).reg);
    }
    std::vector<BlockId> layout;
    for (int64_t turn = 1; turn < turns; ++turn) {
      DraftBlock block;
      block.name = draft_.blocks[at_].name + "_turn_" + std::to_string(turn);
      block.line = draft_.blocks[at_].line;
      block.code = std::move(copies[size_t(turn)].first);
      block.end = DraftBlock::End::Goto;
      block.next = exit;
      layout.push_back(BlockId(draft_.blocks.size()));
      draft_.blocks.push_back(std::move(block));
    }
    draft_.blocks[at_].code = std::move(copies.front().first);
    draft_.blocks[at_].end = DraftBlock::End::Goto;
    draft_.blocks[at_].condition = kNoRegister;
    draft_.blocks[at_].taken = kNoBlock;
    for (int64_t turn = 0; turn + 1 < turns; ++turn) {
      DraftBlock& block = draft_.blocks[turn == 0 ? at_ : first + BlockId(turn) - 1];
      block.end = DraftBlock::End::Branch;
      block.condition = copies[size_t(turn)].second;
      block.negate = true;
      block.taken = exit;
      block.next = first + BlockId(turn);
    }
    draft_.layout.insert(std::find(draft_.layout.begin(), draft_.layout.end(), at_) + 1, layout.begin(),
                         layout.end());
  }

  Draft& draft_;
  VirtualProgram& program_;
  const BlockId at_;
  LoopBody& body_;
  LoopCounter& counter_;
};

}  // namespace

bool unroll_with_exits(Draft& draft, VirtualProgram& program, BlockId at, LoopBody& body,
                       LoopCounter& counter) {
  return LoopWithExits(draft, program, at, body, counter).run();
}

}  // namespace glint::frontend::ptx
