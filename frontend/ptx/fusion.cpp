// Finds pairs of operations on words of which one only feeds the other.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/fusion.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "frontend/ptx/rewriter.h"

namespace glint::frontend::ptx {
namespace {

// Describes logic of up to three words by its truth table: bit 4a + 2b + c of `table` is the result.
struct Logic {
  std::array<VirtualOperand, 3> inputs;
  size_t count = 0;
  uint8_t table = 0;
};
constexpr std::array<uint8_t, 3> kInputTables = {0xf0, 0xcc, 0xaa};

bool is_same(const VirtualOperand& a, const VirtualOperand& b) {
  if (a.kind != b.kind) return false;
  return is_register(a) ? a.reg == b.reg : is_constant(a) && uint32_t(a.constant) == uint32_t(b.constant);
}

class Fusion : Rewriter {
 public:
  explicit Fusion(VirtualProgram& program) : Rewriter(program) {}

  void run() {
    for (VirtualBlock& block : program_.blocks) {
      block_ = &block;
      for (VirtualInst& inst : block.code) {
        if (!is_real(inst)) continue;
        drop_result(inst);
        if (is_guarded(inst)) continue;
        if (!fuse_sum(inst) && !fuse_bound(inst) && !fuse_order(inst) && !fuse_logic(inst) &&
            !fuse_high_word(inst))
          if (!fuse_extension(inst) && !fuse_stride(inst) && !fuse_wide_sum(inst)) fuse_conversion(inst);
      }
    }
  }

 private:
  static bool are_words(std::initializer_list<VirtualOperand> all) {
    const auto constants = std::count_if(all.begin(), all.end(), is_constant);
    return constants <= 1 && std::all_of(all.begin(), all.end(), is_word);
  }

  bool is_add(const VirtualInst& inst) const { return inst.op == ops_.add_u32 || inst.op == ops_.add_s32; }
  bool is_sub(const VirtualInst& inst) const { return inst.op == ops_.sub_u32 || inst.op == sub_s32_; }

  bool fuse_sum(VirtualInst& inst) {
    if (!is_add(inst) && !is_sub(inst)) return false;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualInst* source = feeder(inst.operands[k], inst);
      if (!source) continue;
      const VirtualOperand other = inst.operands[3 - k];
      if (is_add(inst) ? fuse_into_add(inst, *source, other) : fuse_into_sub(inst, *source, other, k))
        return true;
    }
    return false;
  }
  bool fuse_into_add(VirtualInst& inst, const VirtualInst& source, const VirtualOperand& other) {
    const bool shifts = source.op == shr_u32_ || source.op == shr_b32_ || source.op == shr_s32_;
    if (!shifts && !is_add(source) && !is_sub(source)) return false;
    const VirtualOperand a = source.operands[1], b = source.operands[2];
    if (shifts) {
      if (!is_constant(b) || !is_register(a) || !is_word(other)) return false;
      absorb(inst, source.op == shr_s32_ ? shradd_s32_ : shradd_u32_, {a, b, other}, source);
      return true;
    }
    if (!are_words({a, b, other})) return false;
    if (is_add(source))
      absorb(inst, add3_, {a, b, other}, source);
    else
      absorb(inst, addsub_, {a, other, b}, source);
    return true;
  }
  bool fuse_into_sub(VirtualInst& inst, const VirtualInst& source, const VirtualOperand& other, size_t k) {
    const bool multiplies = source.op == ops_.mul_lo_u32 || source.op == ops_.mul_lo_s32;
    if (!multiplies && !is_add(source) && !is_sub(source)) return false;
    const VirtualOperand a = source.operands[1], b = source.operands[2];
    if (multiplies) {
      if (k != 2 || !is_register(a) || !is_constant(b) || !is_word(other)) return false;
      absorb(inst, ops_.mad_lo_u32, {a, VirtualOperand::value(uint32_t(0 - b.constant)), other}, source);
      return true;
    }
    if (!are_words({a, b, other})) return false;
    if (k == 1 && is_add(source))
      absorb(inst, addsub_, {a, b, other}, source);
    else if (is_add(source))
      absorb(inst, subsub_, {other, a, b}, source);
    else if (k == 1)
      absorb(inst, subsub_, {a, b, other}, source);
    else
      absorb(inst, addsub_, {other, b, a}, source);
    return true;
  }

  bool fuse_bound(VirtualInst& inst) {
    const auto row =
        std::find_if(bounds_.begin(), bounds_.end(), [&](const auto& b) { return b[0] == inst.op; });
    if (row == bounds_.end()) return false;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualInst* source = feeder(inst.operands[k], inst);
      const VirtualOperand other = inst.operands[3 - k];
      if (!source || !is_add(*source) || !is_word(other) || !is_word(source->operands[1]) ||
          !is_word(source->operands[2]))
        continue;
      absorb(inst, (*row)[1], {source->operands[1], source->operands[2], other}, *source);
      return true;
    }
    return false;
  }
  // Takes the least or the largest of three.
  bool fuse_order(VirtualInst& inst) {
    const auto row =
        std::find_if(orders_.begin(), orders_.end(), [&](const auto& b) { return b[0] == inst.op; });
    if (row == orders_.end()) return false;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualInst* source = feeder(inst.operands[k], inst);
      const VirtualOperand other = inst.operands[3 - k];
      if (!source || source->op != inst.op || !are_words({source->operands[1], source->operands[2], other}))
        continue;
      absorb(inst, (*row)[1], {source->operands[1], source->operands[2], other}, *source);
      return true;
    }
    return false;
  }

  // Returns what an instruction computes, if that is logic of words.
  std::optional<Logic> logic_of(const VirtualInst& inst) const {
    Logic out;
    const bool is_not = inst.op == not_b32_, is_table = inst.op == lop3_;
    if (!is_not && !is_table && inst.op != and_b32_ && inst.op != or_b32_ && inst.op != xor_b32_) return {};
    if (is_table && !is_constant(inst.operands[4])) return {};
    out.count = is_not ? 1 : is_table ? 3 : 2;
    for (size_t i = 0; i < out.count; ++i) {
      if (!is_word(inst.operands[i + 1])) return {};
      out.inputs[i] = inst.operands[i + 1];
    }
    const uint8_t a = kInputTables[0], b = kInputTables[1];
    out.table = is_not                ? uint8_t(~a)
                : is_table            ? uint8_t(inst.operands[4].constant)
                : inst.op == and_b32_ ? uint8_t(a & b)
                : inst.op == or_b32_  ? uint8_t(a | b)
                                      : uint8_t(a ^ b);
    return without_idle_inputs(out);
  }

  // Drops the inputs that make no difference.
  static Logic without_idle_inputs(Logic logic) {
    for (size_t i = logic.count; i-- > 0;) {
      const unsigned place = 4u >> i;
      bool matters = false;
      for (unsigned entry = 0; entry < 8; ++entry)
        matters |= ((logic.table >> entry ^ logic.table >> (entry ^ place)) & 1) != 0;
      if (matters) continue;
      Logic fewer;
      for (size_t k = 0; k < logic.count; ++k)
        if (k != i) fewer.inputs[fewer.count++] = logic.inputs[k];
      for (unsigned entry = 0; entry < 8; ++entry) {
        // The inputs behind the dropped one move a place up.
        const unsigned before = entry & ~(2 * place - 1) & 7, behind = (entry & (2 * place - 1)) >> 1;
        fewer.table |= uint8_t((logic.table >> (before | behind) & 1) << entry);
      }
      logic = fewer;
    }
    return logic;
  }

  // Returns the logic of `outer` with its input `k` computed by `inner`, if that has at most three inputs.
  static std::optional<Logic> composed(const Logic& outer, size_t k, const Logic& inner) {
    Logic out;
    const auto place = [&](const VirtualOperand& input) -> size_t {
      for (size_t i = 0; i < out.count; ++i)
        if (is_same(out.inputs[i], input)) return i;
      if (out.count < 3) out.inputs[out.count] = input;
      return out.count++;
    };
    std::array<size_t, 3> outer_at{}, inner_at{};
    for (size_t i = 0; i < outer.count; ++i)
      if (i != k) outer_at[i] = place(outer.inputs[i]);
    for (size_t i = 0; i < inner.count; ++i) inner_at[i] = place(inner.inputs[i]);
    if (out.count > 3) return {};
    const auto constants =
        std::count_if(out.inputs.begin(), out.inputs.begin() + std::ptrdiff_t(out.count), is_constant);
    if (constants > 1) return {};
    const auto value = [](const Logic& of, const std::array<unsigned, 3>& bits) {
      return of.table >> (4 * bits[0] + 2 * bits[1] + bits[2]) & 1u;
    };
    for (unsigned entry = 0; entry < 8; ++entry) {
      const std::array<unsigned, 3> bits = {entry >> 2 & 1, entry >> 1 & 1, entry & 1};
      std::array<unsigned, 3> inner_bits{}, outer_bits{};
      for (size_t i = 0; i < inner.count; ++i) inner_bits[i] = bits[inner_at[i]];
      for (size_t i = 0; i < outer.count; ++i)
        outer_bits[i] = i == k ? value(inner, inner_bits) : bits[outer_at[i]];
      out.table |= uint8_t(value(outer, outer_bits) << entry);
    }
    return out;
  }

  bool fuse_logic(VirtualInst& inst) {
    bool changed = false;
    for (bool again = true; again;) {
      again = false;
      const std::optional<Logic> outer = logic_of(inst);
      if (!outer) return changed;
      for (size_t k = 0; k < outer->count && !again; ++k) {
        const VirtualInst* source = feeder(outer->inputs[k], inst);
        const std::optional<Logic> inner = source ? logic_of(*source) : std::nullopt;
        const std::optional<Logic> whole = inner ? composed(*outer, k, *inner) : std::nullopt;
        if (!whole) continue;
        std::vector<VirtualOperand> sources(whole->inputs.begin(),
                                            whole->inputs.begin() + std::ptrdiff_t(whole->count));
        sources.resize(3, VirtualOperand::value(0));
        sources.push_back(VirtualOperand::value(whole->table));
        absorb(inst, lop3_, std::move(sources), *source);
        changed = again = true;
      }
    }
    return changed;
  }

  // Takes the high word of a product without its low word.
  bool fuse_high_word(VirtualInst& inst) {
    if (inst.op != ops_.low_word) return false;
    VirtualInst* shift = feeder(inst.operands[1], inst);
    if (!shift || shift->op != shr_u64_ || !is_constant(shift->operands[2])) return false;
    const uint64_t places = shift->operands[2].constant;
    if (places < 32 || places > 63) return false;
    const VirtualInst* product = feeder(shift->operands[1], *shift);
    if (!product || product->op != ops_.mul_wide_u32) return false;
    for (size_t k : {size_t{1}, size_t{2}})
      if (!is_word(product->operands[k]) ||
          !is_unchanged(registers_, *block_, product->operands[k], *product, inst))
        return false;
    // The three instructions become two in the places of the last two.
    VirtualInst& high = *shift;
    const std::vector<VirtualOperand> factors(product->operands.begin() + 1, product->operands.end());
    if (places == 32) {
      absorb(inst, mul_hi_u32_, factors, *product);
      return true;
    }
    const VirtualOperand word = new_word();
    absorb(high, mul_hi_u32_, factors, *product);
    high.operands[0] = word;
    become(inst, shr_u32_, {word, VirtualOperand::value(places - 32)});
    registers_.last[word.reg] = &high;
    return true;
  }
  VirtualOperand new_word() { return new_value(RegisterClass::B32); }

  // Masks a word before it is extended.
  bool fuse_extension(VirtualInst& inst) {
    if (inst.op != and_b64_) return false;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualOperand mask = inst.operands[3 - k];
      VirtualInst* source = feeder(inst.operands[k], inst);
      if (!source || source->op != ops_.widen_u32 || !is_constant(mask) || mask.constant >> 32 ||
          !is_register(source->operands[1]))
        continue;
      VirtualInst& masked = *source;
      const VirtualOperand word = new_word(), from = masked.operands[1];
      become(masked, and_b32_, {from, mask});
      masked.operands[0] = word;
      become(inst, ops_.widen_u32, {word});
      registers_.last[word.reg] = &masked;
      fuse_logic(masked);
      return true;
    }
    return false;
  }

  // Shifts the constant of a product in place of the product.
  bool fuse_stride(VirtualInst& inst) {
    if (inst.op != ops_.shl_b64 || !is_constant(inst.operands[2])) return false;
    const VirtualInst* source = feeder(inst.operands[1], inst);
    if (!source || (source->op != ops_.mul_wide_u32 && source->op != ops_.mul_wide_s32)) return false;
    const VirtualOperand a = source->operands[1], b = source->operands[2];
    const uint64_t places = inst.operands[2].constant;
    if (!is_register(a) || !is_constant(b) || places > 30 || b.constant << places >> 31) return false;
    absorb(inst, source->op, {a, VirtualOperand::value(b.constant << places)}, *source);
    return true;
  }

  // Adds to a product or to a shifted value of 64 bits.
  bool fuse_wide_sum(VirtualInst& inst) {
    if (inst.op != ops_.add_u64 && inst.op != ops_.add_s64) return false;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualInst* source = feeder(inst.operands[k], inst);
      const VirtualOperand other = inst.operands[3 - k];
      const bool multiplies = source && (source->op == mul_lo_u64_ || source->op == mul_lo_s64_);
      if ((!multiplies && !(source && source->op == ops_.shl_b64)) || !is_word(other)) continue;
      const VirtualOperand a = source->operands[1], b = source->operands[2];
      if (!is_register(a)) continue;
      if (multiplies) {
        if (!is_word(b) || (is_constant(b) && is_constant(other))) continue;
        absorb(inst, mad_lo_u64_, {a, b, other}, *source);
        return true;
      }
      if (is_constant(b) && b.constant < 32 && is_register(other)) {
        absorb(inst, shladd_, {a, b, other}, *source);
        return true;
      }
    }
    return false;
  }

  // Converts the low byte or half of a word without a mask.
  void fuse_conversion(VirtualInst& inst) {
    if (inst.op != float_of_u32_) return;
    const VirtualInst* source = feeder(inst.operands[1], inst);
    if (!source || source->op != and_b32_) return;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualOperand from = source->operands[3 - k], mask = source->operands[k];
      if (!is_register(from) || !is_constant(mask) || (mask.constant != 0xff && mask.constant != 0xffff))
        continue;
      absorb(inst, mask.constant == 0xff ? float_of_u8_ : float_of_u16_, {from}, *source);
      return;
    }
  }

  // Turns an atomic whose old value nobody reads into a reduction.
  void drop_result(VirtualInst& inst) {
    const std::string_view name = row_of(inst).name;
    if (!name.starts_with("atom.") || !is_register(inst.operands[0]) ||
        registers_.uses[inst.operands[0].reg] != 0)
      return;
    const int row = isa::find_op("red" + std::string(name.substr(4)));
    if (row < 0) return;
    inst.op = uint16_t(row);
    inst.operands.erase(inst.operands.begin());
  }

  const uint16_t sub_s32_ = isa::op_index("sub.s32");
  const uint16_t shr_u32_ = isa::op_index("shr.u32"), shr_b32_ = isa::op_index("shr.b32"),
                 shr_s32_ = isa::op_index("shr.s32"), shr_u64_ = isa::op_index("shr.u64");
  const uint16_t add3_ = isa::op_index("add3.u32"), addsub_ = isa::op_index("addsub.u32"),
                 subsub_ = isa::op_index("subsub.u32");
  const uint16_t shradd_u32_ = isa::op_index("shradd.u32"), shradd_s32_ = isa::op_index("shradd.s32");
  const uint16_t mul_hi_u32_ = isa::op_index("mul.hi.u32");
  const uint16_t mul_lo_u64_ = isa::op_index("mul.lo.u64"), mul_lo_s64_ = isa::op_index("mul.lo.s64"),
                 mad_lo_u64_ = isa::op_index("mad.lo.u64"), shladd_ = isa::op_index("shladd.u64");
  const uint16_t float_of_u32_ = isa::op_index("cvt.rn.f32.u32"),
                 float_of_u16_ = isa::op_index("cvt.rn.f32.u16"),
                 float_of_u8_ = isa::op_index("cvt.rn.f32.u8");
  const uint16_t and_b32_ = isa::op_index("and.b32"), or_b32_ = isa::op_index("or.b32"),
                 xor_b32_ = isa::op_index("xor.b32"), not_b32_ = isa::op_index("not.b32"),
                 lop3_ = isa::op_index("lop3.b32"), and_b64_ = isa::op_index("and.b64");
  const std::array<std::array<uint16_t, 2>, 4> bounds_{{
      {isa::op_index("min.s32"), isa::op_index("addmin.s32")},
      {isa::op_index("max.s32"), isa::op_index("addmax.s32")},
      {isa::op_index("min.u32"), isa::op_index("addmin.u32")},
      {isa::op_index("max.u32"), isa::op_index("addmax.u32")},
  }};
  const std::array<std::array<uint16_t, 2>, 4> orders_{{
      {isa::op_index("min.s32"), isa::op_index("min3.s32")},
      {isa::op_index("max.s32"), isa::op_index("max3.s32")},
      {isa::op_index("min.u32"), isa::op_index("min3.u32")},
      {isa::op_index("max.u32"), isa::op_index("max3.u32")},
  }};
};

}  // namespace

void fuse_words(VirtualProgram& program) {
  Fusion(program).run();
}

}  // namespace glint::frontend::ptx
