// Arithmetic, bits and conversions, part by part; dot and matrix products as multiplies and adds in order.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower.h"

namespace glint::frontend {
namespace {

bool is_64(Lowering& l, Id type) {
  const auto& parts = l.layout().parts(type);
  return !parts.empty() && class_of(parts[0]) == RegisterClass::B64;
}

std::string_view name_for(Lowering& l, Id type, const Instruction& inst, const LoweringRow& row) {
  const std::string_view name = is_64(l, type) ? row.name64 : row.name32;
  if (name.empty()) l.unsupported("operation " + std::to_string(uint32_t(inst.op)) + " of 64 bits");
  return name;
}

void unary(Lowering& l, const Instruction& inst, const LoweringRow& row) {
  const std::string_view name = name_for(l, inst.type, inst, row);
  if (name.empty()) return;
  Operands result;
  for (const Operand& a : Operands(l.value(inst.operands[0]))) result.push_back(l.emit().value(name, {a}));
  l.set(inst.result, std::move(result));
}

void binary(Lowering& l, const Instruction& inst, const LoweringRow& row) {
  const std::string_view name = name_for(l, inst.type, inst, row);
  if (name.empty()) return;
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands result;
  for (size_t i = 0; i < a.size(); ++i) result.push_back(l.emit().value(name, {a[i], b[i]}));
  l.set(inst.result, std::move(result));
}

// The count may have another width than the base.
void shift(Lowering& l, const Instruction& inst, const LoweringRow& row) {
  const bool wide_count = is_64(l, l.type_of(inst.operands[1]));
  const std::string_view name = is_64(l, inst.type) ? row.name64 : row.name32;
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands result;
  for (size_t i = 0; i < a.size(); ++i)
    result.push_back(l.emit().value(name, {a[i], wide_count ? l.emit().value("cvt.u32.u64", {b[i]}) : b[i]}));
  l.set(inst.result, std::move(result));
}

void negate_integer(Lowering& l, const Instruction& inst, const LoweringRow&) {
  Operands result;
  const bool wide = is_64(l, inst.type);
  for (const Operand& a : Operands(l.value(inst.operands[0])))
    result.push_back(wide ? l.emit().value("sub.s64", {Operand::value(0), a})
                          : l.emit().value("neg.s32", {a}));
  l.set(inst.result, std::move(result));
}

// SMod: the remainder with the divisor's sign. rem.s32 has the dividend's.
void signed_modulo(Lowering& l, const Instruction& inst, const LoweringRow& row) {
  const std::string_view name = name_for(l, inst.type, inst, row);
  if (name.empty()) return;
  Emitter& e = l.emit();
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands result;
  for (size_t i = 0; i < a.size(); ++i) {
    const Operand rest = e.value(name, {a[i], b[i]});
    const Operand differs = e.value("setp.lt.s32", {e.value("xor.b32", {rest, b[i]}), Operand::value(0)});
    const Operand not_zero = e.value("setp.ne.s32", {rest, Operand::value(0)});
    result.push_back(
        e.select(e.value("and.pred", {differs, not_zero}), e.value("add.s32", {rest, b[i]}), rest));
  }
  l.set(inst.result, std::move(result));
}

// FMod = x - y * floor(x / y), FRem with trunc (Vulkan, "Precision and Operation of SPIR-V Instructions").
void float_modulo(Lowering& l, const Instruction& inst, const LoweringRow& row) {
  Emitter& e = l.emit();
  const Operands x = l.value(inst.operands[0]), y = l.value(inst.operands[1]);
  Operands result;
  for (size_t i = 0; i < x.size(); ++i)
    result.push_back(e.sub(x[i], e.mul(y[i], e.value(row.name32, {e.div(x[i], y[i])}))));
  l.set(inst.result, std::move(result));
}

void times_scalar(Lowering& l, const Instruction& inst, const LoweringRow&) {
  const Operand factor = l.scalar(inst.operands[1]);
  Operands result;
  for (const Operand& a : Operands(l.value(inst.operands[0]))) result.push_back(l.emit().mul(a, factor));
  l.set(inst.result, std::move(result));
}

// Sum of a[i * step_a] * b[i], left to right, no contraction.
Operand dot(Emitter& e, const Operands& a, size_t first_a, size_t step_a, const Operands& b, size_t first_b,
            size_t n) {
  Operand sum = e.mul(a[first_a], b[first_b]);
  for (size_t i = 1; i < n; ++i) sum = e.add(sum, e.mul(a[first_a + i * step_a], b[first_b + i]));
  return sum;
}

void dot_product(Lowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  l.set(inst.result, {dot(l.emit(), a, 0, 1, b, 0, a.size())});
}

// All three products: the left operand has `rows` x `inner` entries by columns, the right `inner` x
// `columns`.
void matrix_product(Lowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  const Type& left = l.module().type(l.type_of(inst.operands[0]));
  const bool left_is_vector = left.kind == Type::Kind::Vector;
  const size_t inner = left.count;  // columns of the matrix, or length of the row vector
  const size_t rows = left_is_vector ? 1 : a.size() / inner;
  Operands result;
  for (size_t column = 0; column * inner < b.size(); ++column)
    for (size_t r = 0; r < rows; ++r) result.push_back(dot(l.emit(), a, r, rows, b, column * inner, inner));
  l.set(inst.result, std::move(result));
}

void outer_product(Lowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands result;
  for (const Operand& column : b)
    for (const Operand& row : a) result.push_back(l.emit().mul(row, column));
  l.set(inst.result, std::move(result));
}

void transpose(Lowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands a = l.value(inst.operands[0]);
  const size_t columns = l.module().type(l.type_of(inst.operands[0])).count, rows = a.size() / columns;
  Operands result;
  for (size_t r = 0; r < rows; ++r)
    for (size_t c = 0; c < columns; ++c) result.push_back(a[c * rows + r]);
  l.set(inst.result, std::move(result));
}

// bfe base, offset, count.
void extract_bits(Lowering& l, const Instruction& inst, const LoweringRow& row) {
  const Operand offset = l.scalar(inst.operands[1]), count = l.scalar(inst.operands[2]);
  Operands result;
  for (const Operand& base : Operands(l.value(inst.operands[0])))
    result.push_back(l.emit().value(row.name32, {base, offset, count}));
  l.set(inst.result, std::move(result));
}

// PTX's bfi puts its first source into its second.
void insert_bits(Lowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands base = l.value(inst.operands[0]), insert = l.value(inst.operands[1]);
  const Operand offset = l.scalar(inst.operands[2]), count = l.scalar(inst.operands[3]);
  Operands result;
  for (size_t i = 0; i < base.size(); ++i)
    result.push_back(l.emit().value("bfi.b32", {insert[i], base[i], offset, count}));
  l.set(inst.result, std::move(result));
}

// Results {low, carry or high}: all of the first member's parts, then all of the second's.
void extended(Lowering& l, const Instruction& inst, const LoweringRow& row) {
  Emitter& e = l.emit();
  const Operands a = l.value(inst.operands[0]), b = l.value(inst.operands[1]);
  Operands first, second;
  for (size_t i = 0; i < a.size(); ++i) {
    first.push_back(e.value(row.name32, {a[i], b[i]}));
    if (inst.op == spv::Op::OpIAddCarry || inst.op == spv::Op::OpISubBorrow) {
      const Operand carry = inst.op == spv::Op::OpIAddCarry ? e.value("setp.lt.u32", {first.back(), a[i]})
                                                            : e.value("setp.lt.u32", {a[i], b[i]});
      second.push_back(e.select(carry, Operand::value(1), Operand::value(0)));
    } else {
      second.push_back(e.value(row.name64, {a[i], b[i]}));
    }
  }
  first.insert(first.end(), second.begin(), second.end());
  l.set(inst.result, std::move(first));
}

// UConvert, SConvert: between 32 and 64 bits.
void convert_width(Lowering& l, const Instruction& inst, const LoweringRow& row) {
  const bool to_wide = is_64(l, inst.type), from_wide = is_64(l, l.type_of(inst.operands[0]));
  Operands result;
  for (const Operand& a : Operands(l.value(inst.operands[0])))
    result.push_back(to_wide == from_wide ? a : l.emit().value(to_wide ? row.name32 : "cvt.u32.u64", {a}));
  l.set(inst.result, std::move(result));
}

// Float and 32-bit integer; 64-bit integers have no conversion in the ISA.
void convert(Lowering& l, const Instruction& inst, const LoweringRow& row) {
  if (is_64(l, inst.type) || is_64(l, l.type_of(inst.operands[0])))
    return l.unsupported("conversion between float and 64-bit integer");
  unary(l, inst, row);
}

void bitcast(Lowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const Operands a = l.value(inst.operands[0]);
  const bool to_wide = is_64(l, inst.type), from_wide = is_64(l, l.type_of(inst.operands[0]));
  Operands result;
  if (to_wide == from_wide) {
    result = a;
  } else if (to_wide) {
    for (size_t i = 0; i + 1 < a.size(); i += 2) result.push_back(e.value("pack.b64", {a[i], a[i + 1]}));
  } else {
    for (const Operand& wide : a) {
      result.push_back(e.value("cvt.u32.u64", {wide}));
      result.push_back(e.value("cvt.u32.u64", {e.value("shr.u64", {wide, Operand::value(32)})}));
    }
  }
  l.set(inst.result, std::move(result));
}

using enum spv::Op;
constexpr LoweringRow kRows[] = {
    {OpIAdd, binary, "add.u32", "add.u64"},
    {OpISub, binary, "sub.u32", "sub.u64"},
    {OpIMul, binary, "mul.lo.u32", "mul.lo.u64"},
    {OpUDiv, binary, "div.u32"},
    {OpSDiv, binary, "div.s32"},
    {OpUMod, binary, "rem.u32"},
    {OpSRem, binary, "rem.s32"},
    {OpSMod, signed_modulo, "rem.s32"},
    {OpSNegate, negate_integer, ""},
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
    {OpShiftLeftLogical, shift, "shl.b32", "shl.b64"},
    {OpShiftRightLogical, shift, "shr.u32", "shr.u64"},
    {OpShiftRightArithmetic, shift, "shr.s32", "shr.s64"},
    {OpBitwiseAnd, binary, "and.b32", "and.b64"},
    {OpBitwiseOr, binary, "or.b32", "or.b64"},
    {OpBitwiseXor, binary, "xor.b32", "xor.b64"},
    {OpNot, unary, "not.b32", "not.b64"},
    {OpBitCount, unary, "popc.b32"},
    {OpBitReverse, unary, "brev.b32"},
    {OpBitFieldSExtract, extract_bits, "bfe.s32"},
    {OpBitFieldUExtract, extract_bits, "bfe.u32"},
    {OpBitFieldInsert, insert_bits, ""},
    {OpIAddCarry, extended, "add.u32"},
    {OpISubBorrow, extended, "sub.u32"},
    {OpUMulExtended, extended, "mul.lo.u32", "mul.hi.u32"},
    {OpSMulExtended, extended, "mul.lo.s32", "mul.hi.s32"},
    {OpConvertFToS, convert, "cvt.rzi.s32.f32"},
    {OpConvertFToU, convert, "cvt.rzi.u32.f32"},
    {OpConvertSToF, convert, "cvt.rn.f32.s32"},
    {OpConvertUToF, convert, "cvt.rn.f32.u32"},
    {OpUConvert, convert_width, "cvt.u64.u32"},
    {OpSConvert, convert_width, "cvt.s64.s32"},
    {OpBitcast, bitcast, ""},
};

}  // namespace

std::span<const LoweringRow> arithmetic_rows() {
  return kRows;
}

}  // namespace glint::frontend
