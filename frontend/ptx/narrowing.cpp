// Finds what is known of the halves of words and pairs.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/narrowing.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/ptx/known_bits.h"
#include "frontend/ptx/rewriter.h"

namespace glint::frontend::ptx {
namespace {

class WordNarrowing : Rewriter {
 public:
  explicit WordNarrowing(VirtualProgram& program) : Rewriter(program), bits_(registers_) {}

  void run() {
    for (VirtualBlock& block : program_.blocks) {
      block_ = &block;
      for (VirtualInst& inst : block.code) {
        if (!is_real(inst) || is_guarded(inst)) continue;
        if (!widen_sum(inst) && !widen_product(inst) && !widen_logic(inst) && !widen_test(inst) &&
            !drop_conversion(inst) && !join_shifts(inst) && !rotate_pair(inst))
          convert_part(inst);
        drop_mask(inst);
      }
    }
  }

 private:
  VirtualOperand word(const VirtualOperand& o) const {
    return is_constant(o) ? VirtualOperand::value(o.constant & 0xffff) : o;
  }
  // Returns the number of bits of a source of 16 bits.
  unsigned width(const VirtualOperand& o) const { return bits_.width(word(o)); }

  bool widen_logic(VirtualInst& inst) {
    const bool is_and = inst.op == and_b16_;
    if (!is_and && inst.op != or_b16_ && inst.op != xor_b16_) return false;
    const unsigned a = width(inst.operands[1]), b = width(inst.operands[2]);
    if ((is_and ? std::min(a, b) : std::max(a, b)) > 16) return false;
    become(inst,
           is_and               ? and_b32_
           : inst.op == or_b16_ ? or_b32_
                                : xor_b32_,
           {word(inst.operands[1]), word(inst.operands[2])});
    return true;
  }

  // Adds, multiplies and shifts as words where no bit is lost beyond 16.
  bool widen_sum(VirtualInst& inst) {
    const auto row =
        std::find_if(sums_.begin(), sums_.end(), [&](const Sum& s) { return s.narrow == inst.op; });
    if (row == sums_.end()) return false;
    const VirtualOperand a = word(inst.operands[1]), b = word(inst.operands[2]);
    const unsigned x = bits_.width(a), y = bits_.width(b);
    if (row->shifts && (!is_constant(b) || b.constant > 15)) return false;
    const unsigned most = row->shifts   ? x + (row->is_left ? unsigned(b.constant) : 0)
                          : row->is_sum ? std::max(x, y) + 1
                                        : x + y;
    if (most > 16) return false;
    become(inst, row->wide, {a, b});
    return true;
  }

  // Multiplies as words, so that a sum can take in the product.
  bool widen_product(VirtualInst& inst) {
    if (inst.op != mul_wide_u16_ && inst.op != mul_wide_s16_) return false;
    const unsigned most = inst.op == mul_wide_u16_ ? 16 : 15;
    if (width(inst.operands[1]) > most || width(inst.operands[2]) > most) return false;
    become(inst, ops_.mul_lo_u32, {word(inst.operands[1]), word(inst.operands[2])});
    return true;
  }

  bool widen_test(VirtualInst& inst) {
    const std::string_view name = row_of(inst).name;
    if (!name.starts_with("setp.") || !name.ends_with("16") || inst.operands.size() != 3) return false;
    const std::string relation(name.substr(5, 2));
    const char kind = name[name.size() - 3];
    if (kind != 's' && kind != 'u' && kind != 'b') return false;
    const bool is_equality = relation == "eq" || relation == "ne";
    if (name.size() != 11) return false;  // setp.RR.T16
    // A signed order needs the sign to be 0.
    const unsigned most = is_equality || kind == 'u' ? 16 : 15;
    if (width(inst.operands[1]) > most || width(inst.operands[2]) > most) return false;
    const int row = isa::find_op("setp." + relation + ".u32");
    if (row < 0) return false;
    become(inst, uint16_t(row), {word(inst.operands[1]), word(inst.operands[2])});
    return true;
  }

  bool drop_conversion(VirtualInst& inst) {
    if (inst.operands.size() != 2 || !is_register(inst.operands[1])) return false;
    const unsigned bits = bits_.width(inst.operands[1]);
    const VirtualInst* source = registers_.definition(inst.operands[1]);
    const std::string_view from = source && is_real(*source) ? row_of(*source).name : "";
    const bool is_extended = from.starts_with("ld.") && (from.ends_with(".s8") || from.ends_with(".s16"));
    const bool is_idle = inst.op == word_of_u16_ || inst.op == u16_of_word_ ? bits <= 16
                         : inst.op == word_of_u8_                           ? bits <= 8
                         : inst.op == word_of_s16_                          ? bits <= 15 || is_extended
                         : inst.op == word_of_s8_ ? bits <= 7 || (is_extended && from.ends_with(".s8"))
                                                  : false;
    if (!is_idle) return false;
    become(inst, ops_.mov_b32, {inst.operands[1]});
    return true;
  }

  // Masks a word without what cut it to 16 bits before, and drops a mask that changes nothing.
  void drop_mask(VirtualInst& inst) {
    if (inst.op != and_b32_) return;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualOperand mask = inst.operands[3 - k], from = inst.operands[k];
      if (!is_constant(mask) || !is_register(from)) continue;
      const auto ones = uint32_t(mask.constant);
      const VirtualInst* cut = source_of(from, inst);
      if (ones <= 0xffff && cut && (cut->op == u16_of_word_ || cut->op == word_of_u16_)) {
        become(inst, and_b32_, {cut->operands[1], mask});
        return;
      }
      const unsigned bits = bits_.width(from);
      if (bits < 32 && (~ones & ((1u << bits) - 1)) == 0) become(inst, ops_.mov_b32, {from});
      return;
    }
  }

  void convert_part(VirtualInst& inst) {
    if (inst.op != float_of_u32_) return;
    const VirtualInst* source = feeder(inst.operands[1], inst);
    if (!source || !is_register(source->operands[1])) return;
    const bool is_field = source->op == bfe_u32_, is_shift = source->op == shr_u32_ || source->op == shr_b32_;
    if (!is_field && !is_shift) return;
    for (size_t k = 2; k < source->operands.size(); ++k)
      if (!is_constant(source->operands[k])) return;
    const uint64_t at = source->operands[2].constant,
                   size = is_field ? source->operands[3].constant : 32 - at;
    const uint16_t op = size == 16 && at == 16  ? float_of_high_
                        : size == 8 && at == 8  ? float_of_byte_[0]
                        : size == 8 && at == 16 ? float_of_byte_[1]
                        : size == 8 && at == 24 ? float_of_byte_[2]
                                                : uint16_t{0};
    if (op != 0) absorb(inst, op, {source->operands[1]}, *source);
  }

  // Rotates a pair. The assembler does so where the parts are added, and not where they are joined by logic.
  bool rotate_pair(VirtualInst& inst) {
    if (inst.op != ops_.add_u64 && inst.op != ops_.add_s64) return false;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualInst *left = feeder(inst.operands[k], inst), *right = feeder(inst.operands[3 - k], inst);
      if (!left || !right || left->op != ops_.shl_b64 || (right->op != shr_u64_ && right->op != shr_b64_))
        continue;
      const VirtualOperand a = left->operands[1], n = left->operands[2], m = right->operands[2];
      if (!is_register(a) || !is_register(right->operands[1]) || right->operands[1].reg != a.reg) continue;
      if (!is_constant(n) || !is_constant(m) || n.constant == 0 || n.constant >= 64 ||
          n.constant + m.constant != 64)
        continue;
      for_each_use(*right, [&](VirtualRegister r) { --registers_.uses[r]; });
      absorb(inst, rotl_, {a, n}, *left);
      return true;
    }
    return false;
  }

  // Takes a word from two by one shift.
  bool join_shifts(VirtualInst& inst) {
    if (inst.op != or_b32_ && inst.op != xor_b32_ && inst.op != ops_.add_u32 && inst.op != ops_.add_s32)
      return false;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualInst *left = feeder(inst.operands[k], inst), *right = feeder(inst.operands[3 - k], inst);
      if (!left || !right || left->op != ops_.shl_b32 || (right->op != shr_u32_ && right->op != shr_b32_))
        continue;
      const VirtualOperand a = left->operands[1], n = left->operands[2], b = right->operands[1],
                           m = right->operands[2];
      if (!is_register(a) || !is_register(b) || !is_constant(n) || !is_constant(m)) continue;
      if (n.constant == 0 || n.constant >= 32 || n.constant + m.constant != 32) continue;
      for_each_use(*right, [&](VirtualRegister r) { --registers_.uses[r]; });
      absorb(inst, shf_left_, {b, a, n}, *left);
      return true;
    }
    return false;
  }

  const uint16_t mul_wide_u16_ = isa::op_index("mul.wide.u16"), mul_wide_s16_ = isa::op_index("mul.wide.s16");
  // Names an op of 16 bits and the same op of words.
  struct Sum {
    uint16_t narrow, wide;
    bool is_sum, shifts, is_left;
  };
  const std::array<Sum, 6> sums_{{
      {isa::op_index("add.s16"), isa::op_index("add.u32"), true, false, false},
      {isa::op_index("add.u16"), isa::op_index("add.u32"), true, false, false},
      {isa::op_index("mul.lo.s16"), isa::op_index("mul.lo.u32"), false, false, false},
      {isa::op_index("mul.lo.u16"), isa::op_index("mul.lo.u32"), false, false, false},
      {isa::op_index("shl.b16"), isa::op_index("shl.b32"), false, true, true},
      {isa::op_index("shr.u16"), isa::op_index("shr.u32"), false, true, false},
  }};
  const KnownBits bits_;
  const uint16_t and_b16_ = isa::op_index("and.b16"), or_b16_ = isa::op_index("or.b16"),
                 xor_b16_ = isa::op_index("xor.b16");
  const uint16_t and_b32_ = isa::op_index("and.b32"), or_b32_ = isa::op_index("or.b32"),
                 xor_b32_ = isa::op_index("xor.b32");
  const uint16_t word_of_u16_ = isa::op_index("cvt.u32.u16"), u16_of_word_ = isa::op_index("cvt.u16.u32"),
                 word_of_u8_ = isa::op_index("cvt.u32.u8"), word_of_s16_ = isa::op_index("cvt.s32.s16"),
                 word_of_s8_ = isa::op_index("cvt.s32.s8");
  const uint16_t shr_u32_ = isa::op_index("shr.u32"), shr_b32_ = isa::op_index("shr.b32"),
                 bfe_u32_ = isa::op_index("bfe.u32"), shr_u64_ = isa::op_index("shr.u64"),
                 shr_b64_ = isa::op_index("shr.b64"), rotl_ = isa::op_index("rotl.b64"),
                 shf_left_ = isa::op_index("shf.l.wrap.b32");
  const uint16_t float_of_u32_ = isa::op_index("cvt.rn.f32.u32"),
                 float_of_high_ = isa::op_index("cvt.rn.f32.u16.h1");
  const std::array<uint16_t, 3> float_of_byte_ = {isa::op_index("cvt.rn.f32.u8.b1"),
                                                  isa::op_index("cvt.rn.f32.u8.b2"),
                                                  isa::op_index("cvt.rn.f32.u8.b3")};
};

class PairNarrowing : Rewriter {
 public:
  explicit PairNarrowing(VirtualProgram& program) : Rewriter(program) {}

  void run() {
    for (VirtualBlock& block : program_.blocks) {
      block_ = &block;
      for (VirtualInst& inst : block.code) {
        if (!is_real(inst)) continue;
        fold_displacement(inst);
        if (is_guarded(inst)) continue;
        if (!add_word(inst) && !take_low_word(inst) && !join_words(inst) && !multiply_words(inst))
          keep_half(inst);
      }
    }
  }

 private:
  // Adds an extended word without a product.
  bool add_word(VirtualInst& inst) {
    if (inst.op != ops_.mad_wide_u32 && inst.op != ops_.mad_wide_s32) return false;
    if (!is_constant(inst.operands[2]) || inst.operands[2].constant != 1) return false;
    become(inst, inst.op == ops_.mad_wide_u32 ? add_wide_u32_ : add_wide_s32_,
           {inst.operands[1], inst.operands[3]});
    return true;
  }

  bool take_low_word(VirtualInst& inst) {
    if (inst.op != ops_.low_word) return false;
    const VirtualInst* source = feeder(inst.operands[1], inst);
    if (!source) return false;
    const std::vector<VirtualOperand>& from = source->operands;
    if ((source->op == add_wide_u32_ || source->op == add_wide_s32_) && is_constant(from[2])) {
      absorb(inst, ops_.add_u32, {from[1], VirtualOperand::value(uint32_t(from[2].constant))}, *source);
      return true;
    }
    if ((source->op == shr_u64_ || source->op == shr_b64_ || source->op == shr_half_) &&
        is_constant(from[2]) && is_register(from[1])) {
      absorb(inst, shr_low_, {from[1], from[2]}, *source);
      return true;
    }
    if ((source->op != ops_.mad_wide_u32 && source->op != ops_.mad_wide_s32) || !is_constant(from[3]))
      return false;
    absorb(inst, ops_.mad_lo_u32, {from[1], from[2], VirtualOperand::value(uint32_t(from[3].constant))},
           *source);
    return true;
  }

  // Returns the word that an instruction extends with zeros, or with its sign.
  std::optional<VirtualOperand> extended(const VirtualOperand& o, uint16_t op,
                                         const VirtualInst& user) const {
    const VirtualInst* source = source_of(o, user);
    if (!source || source->op != op || !is_register(source->operands[1])) return {};
    return source->operands[1];
  }

  bool is_join(const VirtualInst& inst) const {
    return inst.op == or_b64_ || inst.op == xor_b64_ || inst.op == ops_.add_u64 || inst.op == ops_.add_s64;
  }
  bool join_words(VirtualInst& inst) {
    if (!is_join(inst)) return false;
    for (size_t k : {size_t{1}, size_t{2}}) {
      const VirtualInst* high = feeder(inst.operands[k], inst);
      if (!high || high->op != ops_.shl_b64 || !is_constant(high->operands[2]) ||
          high->operands[2].constant != 32)
        continue;
      if (pack(inst, inst.operands[3 - k], *high)) return true;
    }
    return false;
  }
  // Makes a pair of an extended word and of another one that `shift` brings to the high half.
  bool pack(VirtualInst& inst, const VirtualOperand& low, const VirtualInst& shift) {
    const auto a = extended(low, ops_.widen_u32, inst);
    auto b = extended(shift.operands[1], ops_.widen_u32, shift);
    if (!b) b = extended(shift.operands[1], ops_.widen_s32, shift);
    if (!a || !b || !is_unchanged(registers_, *block_, *b, shift, inst)) return false;
    absorb(inst, ops_.pack, {*a, *b}, shift);
    return true;
  }

  bool multiply_words(VirtualInst& inst) {
    if (inst.op != mul_lo_u64_ && inst.op != mul_lo_s64_) return false;
    for (const auto& [extension, product] :
         {std::array{ops_.widen_u32, ops_.mul_wide_u32}, std::array{ops_.widen_s32, ops_.mul_wide_s32}}) {
      const auto a = extended(inst.operands[1], extension, inst);
      if (!a) continue;
      auto b = extended(inst.operands[2], extension, inst);
      const VirtualOperand& factor = inst.operands[2];
      if (!b && is_constant(factor) && factor.constant < 0x8000'0000) b = factor;
      if (!b) continue;
      become(inst, product, {*a, *b});
      return true;
    }
    return false;
  }

  // Returns true if one half of the value is known to be 0.
  bool has_zero_half(const VirtualOperand& o) const {
    if (is_constant(o)) return o.constant >> 32 == 0 || uint32_t(o.constant) == 0;
    const VirtualInst* source = registers_.definition(o);
    return source && is_real(*source) &&
           (source->op == ops_.widen_u32 || source->op == shr_half_ || source->op == shl_half_);
  }
  void keep_half(VirtualInst& inst) {
    const uint16_t op = inst.op == and_b64_                          ? and_half_
                        : inst.op == or_b64_                         ? or_half_
                        : inst.op == xor_b64_                        ? xor_half_
                        : inst.op == ops_.shl_b64                    ? shl_half_
                        : inst.op == shr_u64_ || inst.op == shr_b64_ ? shr_half_
                                                                     : uint16_t{0};
    if (op == 0) return;
    if (op == shl_half_ || op == shr_half_) {
      const VirtualOperand& n = inst.operands[2];
      if (is_constant(n) && n.constant >= 32 && n.constant < 64) inst.op = op;
      return;
    }
    const VirtualOperand &a = inst.operands[1], &b = inst.operands[2];
    const auto has_half_of_ones = [](const VirtualOperand& o) {
      return is_constant(o) && (o.constant >> 32 == 0xffff'ffff || uint32_t(o.constant) == 0xffff'ffff);
    };
    if (has_zero_half(a) || has_zero_half(b) ||
        (op == and_half_ && (has_half_of_ones(a) || has_half_of_ones(b))))
      inst.op = op;
  }

  // Takes a constant that is added to an address into the displacement.
  void fold_displacement(VirtualInst& inst) {
    constexpr int64_t kMost = 1 << 23;  // an instruction of the machine has 24 bits for it
    for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
      if (kind != isa::OperandKind::Address64) return;
      VirtualOperand& base = inst.operands[slot];
      const VirtualInst* sum = source_of(base, inst);
      if (!sum || (sum->op != ops_.add_u64 && sum->op != ops_.add_s64) || !is_register(sum->operands[1]) ||
          !is_constant(sum->operands[2]))
        return;
      const int64_t place = inst.imm + int64_t(sum->operands[2].constant);
      if (place >= kMost || place < -kMost || int64_t(sum->operands[2].constant) >= kMost ||
          int64_t(sum->operands[2].constant) < -kMost)
        return;
      --registers_.uses[base.reg];
      base = sum->operands[1];
      ++registers_.uses[base.reg];
      inst.imm = int32_t(place);
    });
  }

  const uint16_t and_b64_ = isa::op_index("and.b64"), or_b64_ = isa::op_index("or.b64"),
                 xor_b64_ = isa::op_index("xor.b64"), shr_u64_ = isa::op_index("shr.u64"),
                 shr_b64_ = isa::op_index("shr.b64");
  const uint16_t and_half_ = isa::op_index("and.half.b64"), or_half_ = isa::op_index("or.half.b64"),
                 xor_half_ = isa::op_index("xor.half.b64"), shl_half_ = isa::op_index("shl.half.b64"),
                 shr_half_ = isa::op_index("shr.half.u64"), shr_low_ = isa::op_index("shr.low.u64");
  const uint16_t add_wide_u32_ = isa::op_index("add.wide.u32"), add_wide_s32_ = isa::op_index("add.wide.s32");
  const uint16_t mul_lo_u64_ = isa::op_index("mul.lo.u64"), mul_lo_s64_ = isa::op_index("mul.lo.s64");
};

}  // namespace

void narrow_words(VirtualProgram& program) {
  WordNarrowing(program).run();
}
void narrow_pairs(VirtualProgram& program) {
  PairNarrowing(program).run();
}

}  // namespace glint::frontend::ptx
