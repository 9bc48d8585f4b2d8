// Takes floats apart and puts them together: ldexp, frexp, modf.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "frontend/lower/math.h"

namespace glint::frontend::math {
namespace {

// Holds what ldexp and frexp must know of a format.
struct Format {
  int fraction_bits;
  int bias;
  // Returns 2^n with a normal exponent. The high word of a double holds all of it.
  Operand power(Emitter& e, Operand n) const {
    const Operand exponent = e.value("add.s32", {n, word(bias)});
    if (fraction_bits == 23) return e.value("shl.b32", {exponent, word(23)});
    return e.value("pack.b64", {word(0), e.value("shl.b32", {exponent, word(20)})});
  }
};
constexpr Format kSingle{23, 127}, kDouble{52, 1023};

Operand clamped(Emitter& e, Operand n, int low, int high) {
  return e.value("min.s32", {e.value("max.s32", {n, word(low)}), word(high)});
}

}  // namespace

// Multiplies by three factors, because 2^n itself may lie far outside of the format. The factor that may make
// the result subnormal comes last, so the result is rounded once: all products before it are exact, or the
// result is 0.
Operand ldexp(Arithmetic& a, Operand x, Operand n) {
  const Format& format = a.is_double() ? kDouble : kSingle;
  Emitter& e = a.emit();
  const int lowest = 1 - format.bias, highest = format.bias;
  // This is the distance from one end of the format to past the other.
  const int reach = 2 * format.bias + format.fraction_bits + 1;
  const Operand all = clamped(e, n, -reach, reach);
  const Operand last = clamped(e, all, lowest, highest);
  const Operand rest = e.value("sub.s32", {all, last});
  const Operand second = clamped(e, rest, lowest, highest);
  const Operand first = e.value("sub.s32", {rest, second});
  const Operand scaled = a.mul(a.mul(x, format.power(e, first)), format.power(e, second));
  return a.mul(scaled, format.power(e, last));
}

Split frexp(Arithmetic& a, Operand x) {
  const Format& format = a.is_double() ? kDouble : kSingle;
  Emitter& e = a.emit();
  const int up = format.fraction_bits + 1;  // Subnormals are first made normal.
  const double smallest_normal = a.is_double() ? 0x1p-1022 : 0x1p-126;
  const Operand magnitude = a.magnitude(x);
  const Operand is_subnormal = a.less(magnitude, a.constant(smallest_normal));
  const Operand normal = a.select(is_subnormal, a.mul(x, a.constant(double(1ull << up))), x);
  const Operand high =
      a.is_double() ? e.value("cvt.u32.u64", {e.value("shr.u64", {normal, word(32)})}) : normal;
  const int high_bits = a.is_double() ? 20 : 23;  // fraction bits in the word that holds the exponent
  const Operand biased = e.value("bfe.u32", {high, word(high_bits), word(a.is_double() ? 11 : 8)});
  const Operand bias = e.select(is_subnormal, word(format.bias - 1 + up), word(format.bias - 1));
  // The exponent field is replaced by that of 1/2.
  const Operand kept = e.value("and.b32", {high, word(uint32_t((1ll << high_bits) - 1 + 0x8000'0000ll))});
  const Operand half = e.value("or.b32", {kept, word(uint32_t(int64_t(format.bias - 1) << high_bits))});
  const Operand fraction =
      a.is_double() ? e.value("pack.b64", {e.value("cvt.u32.u64", {normal}), half}) : half;
  const Operand is_zero = a.op("setp.eq.f32", {x, a.constant(0)});
  const Operand is_finite = a.op("testp.finite.f32", {x});
  const Operand splits = e.value("and.pred", {is_finite, e.value("not.pred", {is_zero})});
  return {a.select(splits, fraction, x), e.select(splits, e.value("sub.s32", {biased, bias}), word(0))};
}

Split modf(Arithmetic& a, Operand x) {
  const Operand whole = a.op("cvt.rzi.f32.f32", {x});
  const Operand is_whole = a.op("setp.eq.f32", {x, whole});  // true for infinity, too
  return {a.with_sign(a.select(is_whole, a.constant(0), a.sub(x, whole)), x), whole};
}

}  // namespace glint::frontend::math
