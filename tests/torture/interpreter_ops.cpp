// Computes arithmetic, part by part, in plain C++.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>

#include "tests/torture/interpreter.h"

namespace glint::test::torture {

using enum spv::Op;

float float_of(uint64_t bits) {
  return std::bit_cast<float>(uint32_t(bits));
}
double double_of(uint64_t bits) {
  return std::bit_cast<double>(bits);
}
uint64_t bits_of(float x) {
  return std::isnan(x) ? 0x7fff'ffffu : std::bit_cast<uint32_t>(x);
}
uint64_t bits_of(double x) {
  return std::isnan(x) ? 0x7fff'ffff'ffff'ffffull : std::bit_cast<uint64_t>(x);
}
uint64_t cut(uint64_t x, uint32_t width) {
  return width >= 64 ? x : x & ((1ull << width) - 1);
}
int64_t extended(uint64_t x, uint32_t width) {
  return width >= 64 ? int64_t(x) : int64_t(x << (64 - width)) >> (64 - width);
}

namespace {

// Divides. Choice, as in the frontend: division by 0 gives all ones, and its remainder is the dividend; the
// smallest number divided by -1 gives itself and 0.
uint64_t divided(uint64_t a, uint64_t b, uint32_t width, bool is_signed, bool rest) {
  if (b == 0) return rest ? a : ~0ull;
  if (!is_signed) return rest ? a % b : a / b;
  const int64_t x = extended(a, width), y = extended(b, width);
  if (y == -1) return rest ? 0 : 0 - uint64_t(x);
  return uint64_t(rest ? x % y : x / y);
}

uint64_t modulo(uint64_t a, uint64_t b, uint32_t width) {
  const int64_t rest = extended(divided(a, b, width, true, true), width), y = extended(b, width);
  return uint64_t(rest != 0 && (rest < 0) != (y < 0) ? rest + y : rest);
}

// Shifts. Choice: counts from the width on shift everything out.
uint64_t shifted(spv::Op op, uint64_t a, uint64_t count, uint32_t width) {
  if (op == OpShiftRightArithmetic) return uint64_t(extended(a, width) >> std::min<uint64_t>(count, 63));
  if (count >= width) return 0;
  return op == OpShiftLeftLogical ? a << count : a >> count;
}

bool integer_binary(spv::Op op, uint64_t a, uint64_t b, uint32_t width, uint64_t* r) {
  switch (op) {
    case OpIAdd:
      *r = a + b;
      return true;
    case OpISub:
      *r = a - b;
      return true;
    case OpIMul:
      *r = a * b;
      return true;
    case OpUDiv:
      *r = divided(a, b, width, false, false);
      return true;
    case OpSDiv:
      *r = divided(a, b, width, true, false);
      return true;
    case OpUMod:
      *r = divided(a, b, width, false, true);
      return true;
    case OpSRem:
      *r = divided(a, b, width, true, true);
      return true;
    case OpSMod:
      *r = modulo(a, b, width);
      return true;
    case OpBitwiseAnd:
      *r = a & b;
      return true;
    case OpBitwiseOr:
      *r = a | b;
      return true;
    case OpBitwiseXor:
      *r = a ^ b;
      return true;
    case OpLogicalAnd:
      *r = a & b;
      return true;
    case OpLogicalOr:
      *r = a | b;
      return true;
    case OpLogicalEqual:
      *r = a == b;
      return true;
    case OpLogicalNotEqual:
      *r = a != b;
      return true;
    case OpShiftLeftLogical:
    case OpShiftRightLogical:
    case OpShiftRightArithmetic:
      *r = shifted(op, a, b, width);
      return true;
    default:
      return false;
  }
}

bool compare_integers(spv::Op op, uint64_t a, uint64_t b, uint32_t width, uint64_t* r) {
  const int64_t x = extended(a, width), y = extended(b, width);
  switch (op) {
    case OpIEqual:
      *r = a == b;
      return true;
    case OpINotEqual:
      *r = a != b;
      return true;
    case OpULessThan:
      *r = a < b;
      return true;
    case OpULessThanEqual:
      *r = a <= b;
      return true;
    case OpUGreaterThan:
      *r = a > b;
      return true;
    case OpUGreaterThanEqual:
      *r = a >= b;
      return true;
    case OpSLessThan:
      *r = x < y;
      return true;
    case OpSLessThanEqual:
      *r = x <= y;
      return true;
    case OpSGreaterThan:
      *r = x > y;
      return true;
    case OpSGreaterThanEqual:
      *r = x >= y;
      return true;
    default:
      return false;
  }
}

template <class T>
bool compare_floats(spv::Op op, T a, T b, uint64_t* r) {
  const bool unordered = std::isnan(a) || std::isnan(b);
  switch (op) {
    case OpFOrdEqual:
      *r = a == b;
      return true;
    case OpFOrdNotEqual:
      *r = !unordered && a != b;
      return true;
    case OpFOrdLessThan:
      *r = a < b;
      return true;
    case OpFOrdLessThanEqual:
      *r = a <= b;
      return true;
    case OpFOrdGreaterThan:
      *r = a > b;
      return true;
    case OpFOrdGreaterThanEqual:
      *r = a >= b;
      return true;
    case OpFUnordEqual:
      *r = unordered || a == b;
      return true;
    case OpFUnordNotEqual:
      *r = a != b;
      return true;
    case OpFUnordLessThan:
      *r = unordered || a < b;
      return true;
    case OpFUnordLessThanEqual:
      *r = unordered || a <= b;
      return true;
    case OpFUnordGreaterThan:
      *r = unordered || a > b;
      return true;
    case OpFUnordGreaterThanEqual:
      *r = unordered || a >= b;
      return true;
    default:
      return false;
  }
}

template <class T>
bool float_binary(spv::Op op, T a, T b, uint64_t* r) {
  switch (op) {
    case OpFAdd:
      *r = bits_of(a + b);
      return true;
    case OpFSub:
      *r = bits_of(a - b);
      return true;
    case OpVectorTimesScalar:
    case OpFMul:
      *r = bits_of(a * b);
      return true;
    case OpFDiv:
      *r = bits_of(a / b);
      return true;
    // The last product is not rounded.
    case OpFMod:
      *r = bits_of(std::fma(-b, std::floor(a / b), a));
      return true;
    case OpFRem:
      *r = bits_of(std::fma(-b, std::trunc(a / b), a));
      return true;
    default:
      return false;
  }
}

// Truncates, saturates to 32 or 64 bits, and then cuts. Choice, as in hardware: a NaN gives 0 from 32 bits to
// 32, and otherwise only the highest bit.
template <class T>
uint64_t to_integer(T x, bool is_signed, uint32_t width) {
  const uint32_t bits = width > 32 ? 64 : 32;
  if (std::isnan(x)) return sizeof(T) == 4 && bits == 32 ? 0 : 1ull << (bits - 1);
  const T low = is_signed ? -std::ldexp(T(1), int(bits) - 1) : T(0),
          end = std::ldexp(T(1), int(bits) - int(is_signed));
  if (is_signed) {
    if (x < low) return cut(1ull << (bits - 1), width);
    if (x >= end) return cut((1ull << (bits - 1)) - 1, width);
    return cut(uint64_t(int64_t(x)), width);
  }
  if (x <= low) return 0;
  if (x >= end) return cut(~0ull, width);
  return cut(uint64_t(x), width);
}

// Returns x + 0 of bits n, as a float.
template <class T>
uint64_t from_integer(uint64_t x, bool is_signed, uint32_t width) {
  return bits_of(is_signed ? T(extended(x, width)) : T(x));
}

bool convert(spv::Op op, uint64_t a, Scalar to, Scalar from, uint64_t* r) {
  switch (op) {
    case OpConvertFToS:
    case OpConvertFToU: {
      const bool is_signed = op == OpConvertFToS;
      *r = from.width == 64 ? to_integer(double_of(a), is_signed, to.width)
                            : to_integer(float_of(a), is_signed, to.width);
      return true;
    }
    case OpConvertSToF:
    case OpConvertUToF: {
      const bool is_signed = op == OpConvertSToF;
      *r = to.width == 64 ? from_integer<double>(a, is_signed, from.width)
                          : from_integer<float>(a, is_signed, from.width);
      return true;
    }
    case OpFConvert:
      if (from.width == to.width)
        *r = a;
      else
        *r = to.width == 64 ? bits_of(double(float_of(a))) : bits_of(float(double_of(a)));
      return true;
    case OpUConvert:
      *r = a;
      return true;
    case OpSConvert:
      *r = uint64_t(extended(a, from.width));
      return true;
    case OpBitcast:
      *r = a;
      return from.width == to.width;
    default:
      return false;
  }
}

uint32_t reversed(uint32_t x) {
  uint32_t result = 0;
  for (int bit = 0; bit < 32; ++bit) result |= (x >> bit & 1) << (31 - bit);
  return result;
}

bool unary(spv::Op op, uint64_t a, Scalar from, uint64_t* r) {
  const bool is_double = from.width == 64;
  switch (op) {
    case OpSNegate:
      *r = 0 - a;
      return true;
    case OpNot:
      *r = ~a;
      return true;
    case OpLogicalNot:
      *r = !a;
      return true;
    case OpFNegate:
      *r = a ^ 1ull << (from.width - 1);
      return true;
    case OpIsNan:
      *r = is_double ? std::isnan(double_of(a)) : std::isnan(float_of(a));
      return true;
    case OpIsInf:
      *r = is_double ? std::isinf(double_of(a)) : std::isinf(float_of(a));
      return true;
    case OpBitCount:
      *r = uint64_t(std::popcount(a));
      return true;
    case OpBitReverse:
      *r = reversed(uint32_t(a));
      return true;
    default:
      return false;
  }
}

uint64_t field(uint64_t base, uint64_t offset, uint64_t count, bool is_signed) {
  if (count == 0) return 0;
  const uint64_t bits = cut(base >> offset, uint32_t(count));
  return is_signed ? uint64_t(extended(bits, uint32_t(count))) : bits;
}

}  // namespace

// Computes structs of two: all low or sum parts, then all high or carry parts.
static bool compute_extended(spv::Op op, const Value& a, const Value& b, Value* result) {
  result->count = 2 * a.count;
  for (uint32_t i = 0; i < a.count; ++i) {
    const uint64_t x = a.part[i], y = b.part[i];
    uint64_t both = 0;
    if (op == OpIAddCarry) both = x + y;
    if (op == OpISubBorrow) both = cut(x - y, 32) | uint64_t(x < y) << 32;
    if (op == OpUMulExtended) both = x * y;
    if (op == OpSMulExtended) both = uint64_t(extended(x, 32) * extended(y, 32));
    result->part[i] = cut(both, 32);
    result->part[a.count + i] = both >> 32;
  }
  return true;
}

bool compute(const Decoded& inst, Scalar to, Scalar from, const std::vector<const Value*>& x, Value* result) {
  if (x.empty()) return false;
  const Value& a = *x[0];
  const spv::Op op = inst.op;
  if (op == OpIAddCarry || op == OpISubBorrow || op == OpUMulExtended || op == OpSMulExtended)
    return compute_extended(op, a, *x[1], result);
  if (op == OpAny || op == OpAll) {
    const auto end = a.part.begin() + a.count;
    result->count = 1;
    result->part[0] =
        op == OpAny ? std::find(a.part.begin(), end, 1) != end : std::find(a.part.begin(), end, 0) == end;
    return true;
  }
  if (op == OpDot) {
    result->count = 1;
    float sum = float_of(a.part[0]) * float_of(x[1]->part[0]);
    for (uint32_t i = 1; i < a.count; ++i) sum += float_of(a.part[i]) * float_of(x[1]->part[i]);
    result->part[0] = bits_of(sum);
    return true;
  }
  result->count = op == OpSelect ? x[1]->count : a.count;
  for (uint32_t i = 0; i < result->count; ++i) {
    uint64_t& r = result->part[i];
    const auto part = [&](size_t n) { return x[n]->part[x[n]->count == 1 ? 0 : i]; };
    bool known = false;
    if (op == OpSelect) {
      r = part(0) ? part(1) : part(2);
      known = true;
    } else if (op == OpBitFieldSExtract || op == OpBitFieldUExtract) {
      r = field(part(0), x[1]->part[0], x[2]->part[0], op == OpBitFieldSExtract);
      known = true;
    } else if (op == OpBitFieldInsert) {
      const uint64_t mask = cut(~0ull, uint32_t(x[3]->part[0])) << x[2]->part[0];
      r = (part(0) & ~mask) | (part(1) << x[2]->part[0] & mask);
      known = true;
    } else if (x.size() == 1) {
      known = unary(op, part(0), from, &r) || convert(op, part(0), to, from, &r);
    } else if (from.kind == Scalar::Kind::Float) {
      known = from.width == 64 ? float_binary(op, double_of(part(0)), double_of(part(1)), &r) ||
                                     compare_floats(op, double_of(part(0)), double_of(part(1)), &r)
                               : float_binary(op, float_of(part(0)), float_of(part(1)), &r) ||
                                     compare_floats(op, float_of(part(0)), float_of(part(1)), &r);
    } else {
      known = integer_binary(op, part(0), part(1), from.width, &r) ||
              compare_integers(op, part(0), part(1), from.width, &r);
    }
    if (!known) return false;
    r = cut(r, to.kind == Scalar::Kind::Bool ? 1 : to.width);
  }
  return true;
}

}  // namespace glint::test::torture
