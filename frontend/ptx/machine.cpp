// Turns predicates into comparisons, products into sums, words into vectors, and branches into exits.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/machine.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "frontend/backend/def_use.h"
#include "frontend/backend/peephole.h"
#include "frontend/backend/unchanged.h"
#include "frontend/ptx/aggregation.h"
#include "frontend/ptx/fusion.h"
#include "frontend/ptx/logic_tests.h"
#include "frontend/ptx/narrowing.h"
#include "frontend/ptx/negation.h"

namespace glint::frontend::ptx {
namespace {

uint64_t lowest_bit(uint64_t value) {
  return value & (~value + 1);
}

class Shaping {
 public:
  explicit Shaping(VirtualProgram& program)
      : program_(program), registers_(program), users_(program.registers.size()) {
    for (VirtualBlock& block : program.blocks)
      for (VirtualInst& inst : block.code)
        for_each_use(inst, [&](VirtualRegister r) { users_[r].push_back(&inst); });
  }

  void run() {
    for (VirtualBlock& block : program_.blocks) {
      for (VirtualInst& inst : block.code) combine_predicates(block, inst);
      merge_loads(block);
    }
    for (VirtualBlock& block : program_.blocks)
      std::erase_if(block.code, [&](const VirtualInst& inst) { return is_merged(inst); });
  }
  void spread_products() {
    for (VirtualRegister r = 0; r < registers_.last.size(); ++r)
      if (VirtualInst* const product = registers_.definition(VirtualOperand::of(r))) spread(*product, r);
  }

 private:
  // Returns the one definition of an operand. It comes before every use, and its operands hold the same
  // values there.
  VirtualInst* definition(const VirtualOperand& o) const { return registers_.definition(o); }
  bool is_stable(const VirtualOperand& o) const { return is_constant(o) || definition(o); }
  // Returns the suffix that a comparison's name gets for the op that combines its result with another
  // predicate. It is null when there is no such op.
  const char* combination(uint16_t op) const {
    return op == and_pred_ ? ".and" : op == or_pred_ ? ".or" : op == xor_pred_ ? ".xor" : nullptr;
  }

  void combine_predicates(const VirtualBlock& block, VirtualInst& inst) {
    if (!is_real(inst)) return;
    const char* const combined = combination(inst.op);
    if (!combined) return;
    for (size_t k : {size_t{2}, size_t{1}}) {
      const VirtualOperand test = inst.operands[k], other = inst.operands[3 - k];
      const VirtualInst* setp = definition(test);
      if (!setp || registers_.uses[test.reg] != 1 || setp->operands.size() != 3 || !is_register(other))
        continue;
      const std::string name(row_of(*setp).name);
      const size_t type = name.rfind('.');
      if (!name.starts_with("setp.")) continue;
      const int row = isa::find_op(name.substr(0, type) + combined + name.substr(type));
      if (k == 2 && tests_logic(*setp) && is_plain_test(other)) continue;
      if (row < 0 || !is_unchanged(registers_, block, setp->operands[1], *setp, inst) ||
          !is_unchanged(registers_, block, setp->operands[2], *setp, inst))
        continue;
      inst.op = uint16_t(row);
      inst.operands = {inst.operands[0], VirtualOperand::of(new_predicate()), setp->operands[1],
                       setp->operands[2], other};
      return;
    }
  }

  // Returns true for a comparison that becomes one instruction with the logic that it tests
  // (logic_tests.h).
  bool tests_logic(const VirtualInst& setp) const {
    const std::string_view name = row_of(setp).name;
    if ((!name.starts_with("setp.eq.") && !name.starts_with("setp.ne.")) || !name.ends_with("32"))
      return false;
    const VirtualInst* source = definition(setp.operands[1]);
    if (!source || !is_constant(setp.operands[2]) || setp.operands[2].constant != 0) return false;
    const std::string_view of = row_of(*source).name;
    return of == "and.b32" || of == "or.b32" || of == "xor.b32" || of == "lop3.b32";
  }
  // Returns true for the result of another comparison that may be combined.
  bool is_plain_test(const VirtualOperand& o) const {
    const VirtualInst* setp = definition(o);
    return setp && registers_.uses[o.reg] == 1 && setp->operands.size() == 3 &&
           row_of(*setp).name.starts_with("setp.") && !tests_logic(*setp);
  }

  VirtualRegister new_predicate() {
    registers_.definitions.push_back(1);
    registers_.uses.push_back(0);
    registers_.last.push_back(nullptr);
    users_.emplace_back();
    return program_.new_register(RegisterClass::Predicate);
  }

  // Fuses a product that only sums read, if there are several sums. The backend fuses a product that one sum
  // reads.
  void spread(const VirtualInst& product, VirtualRegister r) {
    const uint16_t mad = fused(product);
    if (mad == 0 || registers_.uses[r] < 2) return;
    const VirtualOperand a = product.operands[1];
    const VirtualOperand b = product.op == ops_.shl_b32
                                 ? VirtualOperand::value(uint64_t{1} << product.operands[2].constant)
                                 : product.operands[2];
    if (!is_stable(a) || !is_stable(b)) return;
    const bool wide = program_.registers[r] == RegisterClass::B64;
    for (const VirtualInst* user : users_[r])
      if (!is_sum(*user, r, wide)) return;
    for (VirtualInst* user : users_[r]) {
      const VirtualOperand addend =
          user->operands[is_register(user->operands[1]) && user->operands[1].reg == r ? 2 : 1];
      user->op = mad;
      user->operands = {user->operands[0], a, b, addend};
    }
  }
  uint16_t fused(const VirtualInst& product) const {
    if (product.op == ops_.mul_wide_s32) return ops_.mad_wide_s32;
    if (product.op == ops_.mul_wide_u32) return ops_.mad_wide_u32;
    const bool shifts =
        product.op == ops_.shl_b32 && is_constant(product.operands[2]) && product.operands[2].constant < 32;
    return shifts || product.op == ops_.mul_lo_s32 || product.op == ops_.mul_lo_u32 ? ops_.mad_lo_u32
                                                                                    : uint16_t{0};
  }
  bool is_sum(const VirtualInst& inst, VirtualRegister r, bool wide) const {
    if (!is_real(inst)) return false;
    if (wide ? inst.op != ops_.add_s64 && inst.op != ops_.add_u64
             : inst.op != ops_.add_s32 && inst.op != ops_.add_u32)
      return false;
    int times = 0;
    for (size_t k : {size_t{1}, size_t{2}}) {
      times += is_register(inst.operands[k]) && inst.operands[k].reg == r;
      if (inst.operands[k].kind == VirtualOperand::Kind::StackPointer) return false;
    }
    return times == 1;
  }

  // Returns a power of two that divides the value.
  uint64_t alignment(const VirtualOperand& o, int depth = 0) const {
    constexpr uint64_t kMost = 4096;
    constexpr int kDeepest = 8;
    if (is_constant(o)) return o.constant ? std::min(lowest_bit(o.constant), kMost) : kMost;
    const VirtualInst* source = depth < kDeepest ? definition(o) : nullptr;
    if (!source) return 1;
    const auto of = [&](size_t k) { return alignment(source->operands[k], depth + 1); };
    const uint16_t op = source->op;
    if (op == ops_.mov_b32) return of(1);
    if (op == ops_.add_s32 || op == ops_.add_u32) return std::min(of(1), of(2));
    if (op == ops_.mul_lo_s32 || op == ops_.mul_lo_u32) return std::min(of(1) * of(2), kMost);
    if (op == ops_.mad_lo_u32 || op == mad_lo_s32_) return std::min({of(1) * of(2), of(3), kMost});
    if (op == ops_.shl_b32 && is_constant(source->operands[2]) && source->operands[2].constant < 32)
      return std::min(of(1) << source->operands[2].constant, kMost);
    return 1;
  }

  bool is_merged(const VirtualInst& inst) const {
    return is_real(inst) && inst.op == load_shared_ && inst.operands.empty();
  }
  bool is_word_load(const VirtualInst& inst) const {
    if (!is_real(inst) || inst.op != load_shared_ || is_merged(inst) || is_guarded(inst)) return false;
    return definition(inst.operands[0]) && (is_constant(inst.operands[1]) || definition(inst.operands[1]));
  }

  static bool is_same_place(const VirtualOperand& a, const VirtualOperand& b) {
    return a.kind == b.kind && a.reg == b.reg && a.constant == b.constant;
  }

  // Merges loads into vectors. Nothing between the loads of a group writes memory or waits.
  void merge_loads(VirtualBlock& block) {
    for (size_t begin = 0; begin < block.code.size(); ++begin) {
      if (!is_word_load(block.code[begin])) continue;
      std::vector<VirtualInst*> group;
      for (size_t i = begin; i < block.code.size() && is_pure(block.code[i]); ++i) {
        VirtualInst& inst = block.code[i];
        if (is_word_load(inst) && is_same_place(inst.operands[1], block.code[begin].operands[1]))
          group.push_back(&inst);
      }
      for (size_t words : {size_t{4}, size_t{2}})
        if (merge(group, words)) break;
    }
  }
  // Merges the first load of the group with the loads before and after it in the same vector.
  bool merge(const std::vector<VirtualInst*>& group, size_t words) {
    VirtualInst& first = *group.front();
    const auto bytes = int32_t(4 * words);
    if (first.imm < 0 || alignment(first.operands[1]) % uint64_t(bytes) != 0) return false;
    const int32_t base = first.imm / bytes * bytes;
    std::vector<VirtualInst*> parts;
    for (size_t word = 0; word < words; ++word) {
      const auto at = std::find_if(group.begin(), group.end(),
                                   [&](const VirtualInst* i) { return i->imm == base + int32_t(4 * word); });
      if (at == group.end()) return false;
      parts.push_back(*at);
    }
    std::vector<VirtualOperand> operands;
    for (const VirtualInst* part : parts) operands.push_back(part->operands[0]);
    operands.push_back(first.operands[1]);
    for (VirtualInst* part : parts)
      if (part != &first) part->operands.clear();
    first.op = words == 4 ? load_shared_v4_ : load_shared_v2_;
    first.operands = std::move(operands);
    first.imm = base;
    return true;
  }

  VirtualProgram& program_;
  const Ops ops_;
  const uint16_t and_pred_ = isa::op_index("and.pred"), or_pred_ = isa::op_index("or.pred"),
                 xor_pred_ = isa::op_index("xor.pred");
  const uint16_t mad_lo_s32_ = isa::op_index("mad.lo.s32");
  const uint16_t load_shared_ = isa::op_index("ld.shared.b32");
  const uint16_t load_shared_v2_ = isa::op_index("ld.shared.v2.b32"),
                 load_shared_v4_ = isa::op_index("ld.shared.v4.b32");
  DefUse registers_;
  std::vector<std::vector<VirtualInst*>> users_;
};

}  // namespace

void exit_at_branches(Draft& draft) {
  const size_t blocks = draft.blocks.size();
  for (size_t b = 0; b < blocks; ++b) {
    if (draft.blocks[b].end != DraftBlock::End::Branch) continue;
    const DraftBlock& taken = draft.blocks[draft.blocks[b].taken];
    if (!taken.code.empty() || taken.end != DraftBlock::End::Exit) continue;
    DraftBlock copy;
    copy.name = taken.name;
    copy.line = taken.line;
    copy.returns = taken.returns;
    // The copy is not placed last, because the last exit is where lanes meet.
    draft.layout.insert(draft.layout.begin() + 1, BlockId(draft.blocks.size()));
    draft.blocks[b].taken = BlockId(draft.blocks.size());
    draft.blocks.push_back(std::move(copy));
  }
}

void shape_for_machine(VirtualProgram& program) {
  narrow_words(program);
  Shaping(program).spread_products();
  Shaping(program).run();
  simplify_code(program, Ops());
  fold_negations(program);
  fuse_words(program);
  narrow_pairs(program);
  test_logic(program);
  aggregate_atomics(program);
}

}  // namespace glint::frontend::ptx
