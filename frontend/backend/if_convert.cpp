// Recognises hammocks and diamonds from the lowering's block structure.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/if_convert.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "frontend/backend/slow_paths.h"

namespace glint::frontend {
namespace {

// Limits the instructions of a selection's arms: of one, of one with a load from global memory, and of both.
// `slow_paths` says whether an arm may have an op with a slow path.
// `inside_others` says whether selections that meet where one around them does get guards, too.
struct Longest {
  size_t single, loading, two;
  bool slow_paths, inside_others;
};
constexpr Longest kLongest{4, 4, 6, true, false};
// Source: selections of fused multiply-adds, loads and stores, which one lane or all may take, through the
// assembler of CUDA 13.0 for sm_90. These are the longest that got guards, where lanes may differ.
constexpr Longest kLongestOfAssembler{8, 20, 14, false, true};

using Instructions = std::vector<VirtualInst>;

class Converter {
 public:
  Converter(VirtualProgram& program, const Ops& ops, const Longest& longest)
      : program_(program),
        ops_(ops),
        longest_(longest),
        predecessors_(program.blocks.size()),
        ssys_(program.blocks.size()),
        mentions_(program.registers.size()) {
    for (BlockId b = 0; b < program.blocks.size(); ++b) {
      for (BlockId next : program.blocks[b].successors) predecessors_[next].push_back(b);
      for (const VirtualInst& inst : program.blocks[b].code)
        if (is_real(inst) && inst.op == ops.ssy) ++ssys_[inst.target];
      mention(program.blocks[b].code, 1);
    }
  }

  void run() {
    // The blocks are visited from the back: inner selections come later in the layout and are converted
    // before the selection around them.
    for (BlockId b = BlockId(program_.blocks.size()); b-- > 0;)
      while (convert(b) || (longest_.inside_others && convert_inside(b))) {
      }
  }

 private:
  struct Selection {
    size_t ssy = 0, branch = 0;  // indices in the code of the head block
    BlockId taken = kNoBlock, other = kNoBlock, merge = kNoBlock;
    VirtualRegister condition = kNoRegister;
    bool negate = false;  // negation of the branch's guard
  };

  bool is_plain_branch(const VirtualInst& inst) const {
    return is_real(inst) && inst.op == ops_.bra && !is_guarded(inst);
  }

  // Finds the guarded branch that ends the block. Returns false when there is none.
  bool find_branch(BlockId head, Selection& out) const {
    const Instructions& code = program_.blocks[head].code;
    size_t end = code.size();
    out.other = head + 1;
    if (end > 0 && is_plain_branch(code[end - 1])) out.other = code[--end].target;
    if (end == 0 || !is_real(code[end - 1]) || code[end - 1].op != ops_.bra) return false;
    out.branch = end - 1;
    out.taken = code[out.branch].target;
    out.condition = code[out.branch].guard;
    out.negate = code[out.branch].guard_negate;
    return out.condition != kNoRegister;
  }
  // Finds the selection that ends the block. Returns false when there is none.
  bool find(BlockId head, Selection& out) const {
    if (!find_branch(head, out)) return false;
    const Instructions& code = program_.blocks[head].code;
    for (out.ssy = out.branch; out.ssy-- > 0;)
      if (!is_movable(code[out.ssy])) break;
    if (out.ssy >= out.branch || !is_real(code[out.ssy]) || code[out.ssy].op != ops_.ssy ||
        is_guarded(code[out.ssy]))
      return false;
    out.merge = code[out.ssy].target;
    return out.merge != head && out.taken != out.other;
  }

  // Gets the instructions of an arm. Returns false when the arm cannot be guarded.
  bool arm(BlockId block, BlockId head, const Selection& selection, Instructions& out) const {
    if (block == selection.merge) return true;
    const VirtualBlock& b = program_.blocks[block];
    if (predecessors_[block] != std::vector<BlockId>{head} ||
        b.successors != std::vector<BlockId>{selection.merge})
      return false;
    if (ssys_[block] != 0) return false;
    out = b.code;
    if (!out.empty() && is_plain_branch(out.back())) out.pop_back();
    if (out.size() > 2 * std::max(longest_.two, longest_.loading)) return false;
    for (const VirtualInst& inst : out) {
      if (!is_movable(inst) || is_guarded(inst) || (!longest_.slow_paths && has_slow_path(inst.op)))
        return false;
      bool writes_condition = false;
      for_each_def(inst, [&](VirtualRegister r) { writes_condition |= r == selection.condition; });
      if (writes_condition) return false;
    }
    write_results_directly(out);
    return true;
  }

  // Turns `add t, a, b; mov x, t` into `add x, a, b` when nothing else reads t and nothing between touches x.
  // A temporary that is read outside of the arm is not renamed.
  void write_results_directly(Instructions& arm) const {
    for (size_t m = 0; m < arm.size(); ++m) {
      if (!ops_.is_move(arm[m].op) || !is_register(arm[m].operands[1])) continue;
      const VirtualRegister to = arm[m].operands[0].reg, from = arm[m].operands[1].reg;
      if (mentions_[from] != 2) continue;  // It has one definition and this use.
      for (size_t d = m; d-- > 0;) {
        bool defines = false, touches = false;
        for_each_def(arm[d], [&](VirtualRegister r) {
          defines |= r == from;
          touches |= r == to;
        });
        if (defines) {
          if (touches) break;
          for_each_slot(row_of(arm[d]), [&](size_t slot, isa::OperandKind kind) {
            VirtualOperand& o = arm[d].operands[slot];
            if (isa::is_destination(kind) && is_register(o) && o.reg == from) o.reg = to;
          });
          arm.erase(arm.begin() + std::ptrdiff_t(m--));
          break;
        }
        for_each_use(arm[d], [&](VirtualRegister r) { touches |= r == to; });
        if (touches) break;
      }
    }
  }

  // Adds to the number of times that the whole program mentions each register.
  void mention(std::span<const VirtualInst> code, int times) {
    const auto visit = [&](VirtualRegister r) { mentions_[r] += uint32_t(times); };
    for (const VirtualInst& inst : code) {
      for_each_def(inst, visit);
      for_each_use(inst, visit);
    }
  }

  static bool loads_from_global(const VirtualInst& inst) {
    return row_of(inst).memory.space == isa::Space::Global && is_pure(inst);
  }

  bool convert(BlockId head) {
    Selection s;
    if (!find(head, s) || ssys_[s.merge] != 1) return false;
    const VirtualBlock& merge = program_.blocks[s.merge];
    if (merge.code.empty() || !is_real(merge.code.front()) || merge.code.front().op != ops_.join)
      return false;
    for (BlockId from : predecessors_[s.merge])
      if (from != head && from != s.taken && from != s.other) return false;
    Instructions taken, other;
    if (!arm(s.taken, head, s, taken) || !arm(s.other, head, s, other)) return false;
    if (!are_short(taken, other)) return false;
    rewrite(head, s, std::move(taken), std::move(other));
    return true;
  }
  bool are_short(const Instructions& taken, const Instructions& other) const {
    const bool has_two = !taken.empty() && !other.empty();
    const bool loads = std::any_of(taken.begin(), taken.end(), loads_from_global) ||
                       std::any_of(other.begin(), other.end(), loads_from_global);
    return taken.size() + other.size() <= (has_two ? longest_.two
                                           : loads ? longest_.loading
                                                   : longest_.single);
  }

  // Guards both arms of a selection that has no region of its own: its lanes meet where those of a selection
  // around it meet, and the block still ends in a branch to that place.
  bool convert_inside(BlockId head) {
    Selection s;
    if (!find_branch(head, s) || program_.blocks[s.taken].successors.size() != 1) return false;
    s.merge = program_.blocks[s.taken].successors.front();
    Instructions taken, other;
    if (s.merge == head || s.merge == s.taken || s.merge == s.other || s.taken == s.other) return false;
    if (!arm(s.taken, head, s, taken) || !arm(s.other, head, s, other) || !are_short(taken, other))
      return false;
    VirtualBlock& block = program_.blocks[head];
    for (BlockId gone : {s.taken, s.other}) mention(program_.blocks[gone].code, -1);
    mention(std::span(block.code).subspan(s.branch), -1);
    VirtualInst leave = make_inst(ops_.bra, {}, block.code[s.branch].line);
    leave.target = s.merge;
    Instructions selected = select_moves(taken, other, s);
    block.code.resize(s.branch);
    append(block.code, taken, s.condition, s.negate);
    append(block.code, other, s.condition, !s.negate);
    block.code.insert(block.code.end(), selected.begin(), selected.end());
    block.code.push_back(std::move(leave));
    mention(std::span(block.code).subspan(s.branch), 1);
    block.successors = {s.merge};
    std::erase_if(predecessors_[s.merge], [&](BlockId b) { return b == s.taken || b == s.other; });
    predecessors_[s.merge].push_back(head);
    for (BlockId gone : {s.taken, s.other}) {
      program_.blocks[gone].code.clear();
      program_.blocks[gone].successors.clear();
      predecessors_[gone].clear();
    }
    return true;
  }

  void rewrite(BlockId head, const Selection& s, Instructions taken, Instructions other) {
    VirtualBlock& block = program_.blocks[head];
    VirtualBlock& merge = program_.blocks[s.merge];
    Instructions selected = select_moves(taken, other, s);
    for (BlockId gone : {s.taken, s.other})
      if (gone != s.merge) mention(program_.blocks[gone].code, -1);
    mention(std::span(block.code).subspan(s.branch), -1);
    block.code.resize(s.branch);
    block.code.erase(block.code.begin() + std::ptrdiff_t(s.ssy));
    if (may_run_first(taken, other)) {
      block.code.insert(block.code.end(), taken.begin(), taken.end());
      taken.clear();
    } else if (may_run_first(other, taken)) {
      block.code.insert(block.code.end(), other.begin(), other.end());
      other.clear();
    }
    append(block.code, taken, s.condition, s.negate);
    append(block.code, other, s.condition, !s.negate);
    block.code.insert(block.code.end(), selected.begin(), selected.end());
    mention(std::span(block.code).subspan(s.branch - 1), 1);
    block.code.insert(block.code.end(), std::make_move_iterator(merge.code.begin() + 1),
                      std::make_move_iterator(merge.code.end()));
    if (!ends(block.code)) {
      block.code.push_back(
          make_inst(ops_.bra, {}, block.code.empty() ? isa::Line{} : block.code.back().line));
      block.code.back().target = s.merge + 1;
    }
    block.successors = merge.successors;
    for (BlockId next : block.successors)
      std::replace(predecessors_[next].begin(), predecessors_[next].end(), s.merge, head);
    for (BlockId gone : {s.taken, s.other, s.merge}) {
      program_.blocks[gone].code.clear();
      program_.blocks[gone].successors.clear();
      predecessors_[gone].clear();
    }
  }

  static bool ends(const Instructions& code) {
    if (code.empty() || !is_real(code.back()) || is_guarded(code.back())) return false;
    return isa::ends_block(row_of(code.back()).effect);
  }

  // Returns true when all lanes may run `arm` before the lanes of `rest` run `rest`. This holds if `arm`
  // consists of moves to registers that `rest` also writes and does not read. Moves without guards can be
  // coalesced.
  bool may_run_first(const Instructions& arm, const Instructions& rest) const {
    for (const VirtualInst& inst : arm) {
      if (!ops_.is_move(inst.op)) return false;
      bool is_read = false;
      for (const Instructions* code : {&arm, &rest})
        for (const VirtualInst& reader : *code)
          for_each_use(reader, [&](VirtualRegister r) { is_read |= r == inst.operands[0].reg; });
      if (is_read || !is_written(rest, inst.operands[0])) return false;
    }
    return true;
  }

  static void append(Instructions& code, Instructions& arm, VirtualRegister condition, bool negate) {
    for (VirtualInst& inst : arm) {
      inst.guard = condition;
      inst.guard_negate = negate;
      code.push_back(std::move(inst));
    }
  }

  static bool is_written(const Instructions& arm, const VirtualOperand& o) {
    bool found = false;
    for (const VirtualInst& inst : arm)
      for_each_def(inst, [&](VirtualRegister r) { found |= is_register(o) && r == o.reg; });
    return found;
  }

  // Removes moves at the ends of both arms that write the same register, and returns them as selp
  // instructions.
  Instructions select_moves(Instructions& taken, Instructions& other, const Selection& s) const {
    Instructions out;
    while (!taken.empty() && !other.empty()) {
      const VirtualInst &a = taken.back(), &b = other.back();
      if (a.op != b.op || (a.op != ops_.mov_b32 && a.op != ops_.mov_b64)) break;
      if (a.operands[0].reg != b.operands[0].reg) break;
      // A source that an arm computes exists only under the guard.
      if (is_written(taken, a.operands[1]) || is_written(other, b.operands[1])) break;
      const auto& [yes, no] = s.negate ? std::pair{b, a} : std::pair{a, b};
      out.insert(out.begin(),
                 make_inst(a.op == ops_.mov_b64 ? ops_.selp_b64 : ops_.selp_b32,
                           {a.operands[0], yes.operands[1], no.operands[1], VirtualOperand::of(s.condition)},
                           a.line));
      taken.pop_back();
      other.pop_back();
    }
    return out;
  }

  VirtualProgram& program_;
  const Ops& ops_;
  const Longest longest_;
  std::vector<std::vector<BlockId>> predecessors_;
  std::vector<uint32_t> ssys_;
  std::vector<uint32_t> mentions_;  // by register
};

}  // namespace

void convert_selections(VirtualProgram& program, const Ops& ops, bool like_an_assembler) {
  Converter(program, ops, like_an_assembler ? kLongestOfAssembler : kLongest).run();
}

}  // namespace glint::frontend
