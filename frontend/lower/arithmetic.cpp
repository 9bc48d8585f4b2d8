// Lowers arithmetic and bit operations part by part, and dot and matrix products as multiplies and adds in
// order.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "frontend/lower/lowering.h"
#include "frontend/lower/typed.h"

namespace glint::frontend {
namespace {

// Returns whether the ISA has the op, and reports it as unsupported when no row computes it.
bool has_op(ModuleLowering& l, std::string_view name, Part part) {
  if (has_typed(name, part)) return true;
  l.unsupported("no op " + with_bits(name, 8 * bytes_of(part)));
  return false;
}

void unary(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const Part part = l.part_of(inst.type);
  if (!has_op(l, row.name32, part)) return;
  Operands result;
  for (const Operand& a : Operands(l.value(inst.operands[0])))
    result.push_back(typed(l.emit(), row.name32, part, {a}));
  l.set(inst.result, std::move(result));
}

void binary(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const Part part = l.part_of(inst.type);
  if (!has_op(l, row.name32, part)) return;
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands result;
  for (size_t i = 0; i < a.size(); ++i) result.push_back(typed(l.emit(), row.name32, part, {a[i], b[i]}));
  l.set(inst.result, std::move(result));
}

// Lowers a shift, whose count may have another width than the base. Choice: a count that is not below the
// base's width shifts all bits out, as in PTX.
void shift(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  Emitter& e = l.emit();
  const Part part = l.part_of(inst.type), count_part = l.part_of(l.type_of(inst.operands[1]));
  const bool is_signed = row.name32.find(".s32") != std::string_view::npos;
  const std::string name = with_bits(row.name32, bytes_of(part) == 8 ? 64 : 32);
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands result;
  for (size_t i = 0; i < a.size(); ++i) {
    const Operand count = bytes_of(count_part) == 8
                              ? e.value("cvt.u32.u64", {e.value("min.u64", {b[i], Operand::value(64)})})
                              : b[i];
    result.push_back(narrowed(e, part, e.value(name, {widened(e, part, a[i], is_signed), count})));
  }
  l.set(inst.result, std::move(result));
}

// Lowers SMod, the remainder with the divisor's sign. rem.s32 has the dividend's sign.
void signed_modulo(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  Emitter& e = l.emit();
  const Part part = l.part_of(inst.type);
  if (!has_op(l, row.name32, part)) return;
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands result;
  for (size_t i = 0; i < a.size(); ++i) {
    const Operand rest = typed(e, row.name32, part, {a[i], b[i]});
    const Operand signs = typed(e, "xor.b32", part, {rest, b[i]});
    const Operand differs = typed(e, "setp.lt.s32", part, {signs, Operand::value(0)});
    const Operand not_zero = typed(e, "setp.ne.s32", part, {rest, Operand::value(0)});
    const Operand sum = typed(e, "add.s32", part, {rest, b[i]});
    result.push_back(e.select(e.value("and.pred", {differs, not_zero}), sum, rest));
  }
  l.set(inst.result, std::move(result));
}

// Lowers FMod as x - y * floor(x / y), and FRem with trunc (Vulkan, "Precision and Operation of SPIR-V
// Instructions"). The product is not rounded: it is close to x, so its rounding error would be a large part
// of the result.
void float_modulo(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  Emitter& e = l.emit();
  const Part part = l.part_of(inst.type);
  const Operands x = l.value(inst.operands[0]), y = l.value(inst.operands[1]);
  Operands result;
  for (size_t i = 0; i < x.size(); ++i) {
    const Operand quotient = typed(e, row.name32, part, {typed(e, "div.rn.f32", part, {x[i], y[i]})});
    result.push_back(typed(e, "fma.rn.f32", part, {typed(e, "neg.f32", part, {y[i]}), quotient, x[i]}));
  }
  l.set(inst.result, std::move(result));
}

void times_scalar(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Part part = l.part_of(inst.type);
  const Operand factor = l.scalar(inst.operands[1]);
  Operands result;
  for (const Operand& a : Operands(l.value(inst.operands[0])))
    result.push_back(typed(l.emit(), "mul.rn.f32", part, {a, factor}));
  l.set(inst.result, std::move(result));
}

// Returns the sum of a[i * step_a] * b[i], added left to right without contraction.
Operand dot(Emitter& e, Part part, const Operands& a, size_t first_a, size_t step_a, const Operands& b,
            size_t first_b, size_t n) {
  const auto product = [&](size_t i) {
    return typed(e, "mul.rn.f32", part, {a[first_a + i * step_a], b[first_b + i]});
  };
  Operand sum = product(0);
  for (size_t i = 1; i < n; ++i) sum = typed(e, "add.rn.f32", part, {sum, product(i)});
  return sum;
}

void dot_product(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  l.set(inst.result, {dot(l.emit(), l.part_of(inst.type), a, 0, 1, b, 0, a.size())});
}

// Lowers all three matrix products. The left operand has `rows` x `inner` entries, the right one `inner` x
// `columns`, both stored by columns.
void matrix_product(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  const Type& left = l.module().type(l.type_of(inst.operands[0]));
  const bool left_is_vector = left.kind == Type::Kind::Vector;
  const size_t inner = left.count;  // columns of the matrix, or length of the row vector
  const size_t rows = left_is_vector ? 1 : a.size() / inner;
  const Part part = l.part_of(inst.type);
  Operands result;
  for (size_t column = 0; column * inner < b.size(); ++column)
    for (size_t r = 0; r < rows; ++r)
      result.push_back(dot(l.emit(), part, a, r, rows, b, column * inner, inner));
  l.set(inst.result, std::move(result));
}

void outer_product(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands result;
  for (const Operand& column : b)
    for (const Operand& row : a)
      result.push_back(typed(l.emit(), "mul.rn.f32", l.part_of(inst.type), {row, column}));
  l.set(inst.result, std::move(result));
}

void transpose(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands a = l.value(inst.operands[0]);
  const size_t columns = l.module().type(l.type_of(inst.operands[0])).count, rows = a.size() / columns;
  Operands result;
  for (size_t r = 0; r < rows; ++r)
    for (size_t c = 0; c < columns; ++c) result.push_back(a[c * rows + r]);
  l.set(inst.result, std::move(result));
}

// Returns whether the operands have 32 bits, which Vulkan requires of the base.
bool has_32_bits(ModuleLowering& l, const Instruction& inst) {
  if (bytes_of(l.part_of(inst.type)) == 4 && bytes_of(l.part_of(l.type_of(inst.operands[0]))) == 4)
    return true;
  l.unsupported("bit instructions of other than 32 bits");
  return false;
}

void count_or_reverse(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  if (has_32_bits(l, inst)) unary(l, inst, row);
}

// Lowers a bit-field extraction to: bfe base, offset, count.
void extract_bits(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  if (!has_32_bits(l, inst)) return;
  const Operand offset = l.scalar(inst.operands[1]), count = l.scalar(inst.operands[2]);
  Operands result;
  for (const Operand& base : Operands(l.value(inst.operands[0])))
    result.push_back(l.emit().value(row.name32, {base, offset, count}));
  l.set(inst.result, std::move(result));
}

// Lowers a bit-field insertion. PTX's bfi inserts its first source into its second.
void insert_bits(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  if (!has_32_bits(l, inst)) return;
  const Operands base = l.value(inst.operands[0]), insert = l.value(inst.operands[1]);
  const Operand offset = l.scalar(inst.operands[2]), count = l.scalar(inst.operands[3]);
  Operands result;
  for (size_t i = 0; i < base.size(); ++i)
    result.push_back(l.emit().value("bfi.b32", {insert[i], base[i], offset, count}));
  l.set(inst.result, std::move(result));
}

// Lowers ops with the result {low, carry or high}: all parts of the first member come before those of the
// second.
void extended(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  Emitter& e = l.emit();
  const std::string_view high = inst.op == spv::Op::OpSMulExtended ? "mul.hi.s32" : "mul.hi.u32";
  const Part part = l.part_of(l.type_of(inst.operands[0]));
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands first, second;
  for (size_t i = 0; i < a.size(); ++i) {
    if (bytes_of(part) < 4 && inst.op != spv::Op::OpISubBorrow) {  // 32 bits hold the whole result.
      const bool is_signed = inst.op == spv::Op::OpSMulExtended;
      const Operand whole =
          e.value(row.name32, {widened(e, part, a[i], is_signed), widened(e, part, b[i], is_signed)});
      first.push_back(narrowed(e, part, whole));
      second.push_back(narrowed(e, part, e.value("shr.u32", {whole, Operand::value(8 * bytes_of(part))})));
      continue;
    }
    first.push_back(typed(e, row.name32, part, {a[i], b[i]}));
    if (inst.op == spv::Op::OpIAddCarry || inst.op == spv::Op::OpISubBorrow) {
      const Operand carry = inst.op == spv::Op::OpIAddCarry
                                ? typed(e, "setp.lt.u32", part, {first.back(), a[i]})
                                : typed(e, "setp.lt.u32", part, {a[i], b[i]});
      second.push_back(typed(e, "selp.b32", part, {Operand::value(1), Operand::value(0), carry}));
    } else {
      second.push_back(typed(e, high, part, {a[i], b[i]}));
    }
  }
  first.insert(first.end(), second.begin(), second.end());
  l.set(inst.result, std::move(first));
}

using enum spv::Op;
constexpr LoweringRow kArithmeticRows[] = {
    {OpIAdd, binary, "add.u32"},
    {OpISub, binary, "sub.u32"},
    {OpIMul, binary, "mul.lo.u32"},
    {OpUDiv, binary, "div.u32"},
    {OpSDiv, binary, "div.s32"},
    {OpUMod, binary, "rem.u32"},
    {OpSRem, binary, "rem.s32"},
    {OpSMod, signed_modulo, "rem.s32"},
    {OpSNegate, unary, "neg.s32"},
    {OpFAdd, binary, "add.rn.f32"},
    {OpFSub, binary, "sub.rn.f32"},
    {OpFMul, binary, "mul.rn.f32"},
    {OpFDiv, binary, "div.rn.f32"},
    {OpFMod, float_modulo, "cvt.rmi.f32.f32"},
    {OpFRem, float_modulo, "cvt.rzi.f32.f32"},
    {OpFNegate, unary, "neg.f32"},
    {OpVectorTimesScalar, times_scalar, ""},
    {OpMatrixTimesScalar, times_scalar, ""},
    {OpMatrixTimesVector, matrix_product, ""},
    {OpVectorTimesMatrix, matrix_product, ""},
    {OpMatrixTimesMatrix, matrix_product, ""},
    {OpDot, dot_product, ""},
    {OpOuterProduct, outer_product, ""},
    {OpTranspose, transpose, ""},
    {OpShiftLeftLogical, shift, "shl.b32"},
    {OpShiftRightLogical, shift, "shr.u32"},
    {OpShiftRightArithmetic, shift, "shr.s32"},
    {OpBitwiseAnd, binary, "and.b32"},
    {OpBitwiseOr, binary, "or.b32"},
    {OpBitwiseXor, binary, "xor.b32"},
    {OpNot, unary, "not.b32"},
    {OpBitCount, count_or_reverse, "popc.b32"},
    {OpBitReverse, count_or_reverse, "brev.b32"},
    {OpBitFieldSExtract, extract_bits, "bfe.s32"},
    {OpBitFieldUExtract, extract_bits, "bfe.u32"},
    {OpBitFieldInsert, insert_bits, ""},
    {OpIAddCarry, extended, "add.u32"},
    {OpISubBorrow, extended, "sub.u32"},
    {OpUMulExtended, extended, "mul.lo.u32"},
    {OpSMulExtended, extended, "mul.lo.s32"},
};

}  // namespace

std::span<const LoweringRow> arithmetic_rows() {
  return kArithmeticRows;
}

}  // namespace glint::frontend
