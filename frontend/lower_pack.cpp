// Packing by integer ops; the formulas of GLSL 4.60, 8.4 "Floating-Point Pack and Unpack Functions".
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower_pack.h"

namespace glint::frontend::pack {
namespace {

Operand word(uint32_t bits) { return Operand::value(bits); }

// Joins fields of `width` bits, the first lowest. The fields above it must be clean.
Operands join(Emitter& e, const Operands& fields, uint32_t width) {
  Operand all = fields[0];
  for (uint32_t i = 1; i < fields.size(); ++i)
    all = e.value("or.b32", {all, e.value("shl.b32", {fields[i], word(i * width)})});
  return {all};
}

Operands pack_normalised(Emitter& e, const Operands& x, uint32_t width, bool is_signed) {
  const uint32_t mask = (1u << width) - 1;
  const float scale = float(is_signed ? mask >> 1 : mask);
  Operands fields;
  for (const Operand& part : x) {
    const Operand low = constant_f32(is_signed ? -1.0f : 0.0f);
    // NaN becomes 1 where signed and 0 where not, as on hardware: min and max give their other operand.
    const Operand clamped = is_signed ? e.value("max.f32", {e.value("min.f32", {part, constant_f32(1)}), low})
                                      : e.value("min.f32", {e.value("max.f32", {part, low}), constant_f32(1)});
    const Operand rounded = e.value("cvt.rni.f32.f32", {e.mul(clamped, constant_f32(scale))});
    fields.push_back(e.value("and.b32", {e.value("cvt.rzi.s32.f32", {rounded}), word(mask)}));
  }
  return join(e, fields, width);
}

Operands unpack_normalised(Emitter& e, const Operand& x, uint32_t width, bool is_signed) {
  const uint32_t mask = (1u << width) - 1;
  Operands result;
  for (uint32_t at = 0; at < 32; at += width) {
    const Operand field = e.value(is_signed ? "bfe.s32" : "bfe.u32", {x, word(at), word(width)});
    const Operand number = e.value(is_signed ? "cvt.rn.f32.s32" : "cvt.rn.f32.u32", {field});
    const Operand ratio = e.div(number, constant_f32(float(is_signed ? mask >> 1 : mask)));
    result.push_back(is_signed ? e.value("max.f32", {ratio, constant_f32(-1)}) : ratio);  // never above 1
  }
  return result;
}

constexpr uint32_t kRebias = uint32_t(127 - 15) << 23;  // between the exponents of float and half
constexpr uint32_t kSmallestNormal = 0x3880'0000;       // 2^-14, of half

Operand to_half(Emitter& e, const Operand& x) {
  const Operand sign = e.value("and.b32", {e.value("shr.u32", {x, word(16)}), word(0x8000)});
  const Operand magnitude = e.value("and.b32", {x, word(0x7fff'ffff)});
  // Normal: half of the last place is added, a bit less when the place is even. Carries make infinity by themselves.
  const Operand odd = e.value("bfe.u32", {magnitude, word(13), word(1)});
  const Operand rounded = e.value("add.u32", {e.value("add.u32", {magnitude, word(0xfffu - kRebias)}), odd});
  const Operand normal = e.value("shr.u32", {rounded, word(13)});
  // Subnormal: next to 1/2 a float's last place is 2^-24, as a half's is near 0.
  const Operand subnormal = e.value("sub.u32", {e.add(magnitude, constant_f32(0.5f)), constant_f32(0.5f)});
  const Operand is_nan = e.value("setp.gt.u32", {magnitude, word(0x7f80'0000)});
  const Operand special = e.select(is_nan, word(0x7e00), word(0x7c00));
  const Operand small = e.value("setp.lt.u32", {magnitude, word(kSmallestNormal)});
  const Operand large = e.value("setp.ge.u32", {magnitude, word(0x4780'0000)});  // 65536
  return e.value("or.b32", {sign, e.select(large, special, e.select(small, subnormal, normal))});
}

Operand from_half(Emitter& e, const Operand& x, uint32_t at) {
  const Operand half = e.value("bfe.u32", {x, word(at), word(16)});
  const Operand sign = e.value("shl.b32", {e.value("and.b32", {half, word(0x8000)}), word(16)});
  const Operand shifted = e.value("shl.b32", {e.value("and.b32", {half, word(0x7fff)}), word(13)});
  const Operand normal = e.value("add.u32", {shifted, word(kRebias)});
  const Operand special = e.value("add.u32", {normal, word(kRebias)});  // infinity, NaN
  // Subnormal: as if normal with the smallest exponent, then without the leading 1 that it has not.
  const Operand subnormal =
      e.sub(e.value("add.u32", {normal, word(1u << 23)}), Operand::value(kSmallestNormal));
  const Operand small = e.value("setp.lt.u32", {shifted, word(1u << 23)});
  const Operand large = e.value("setp.ge.u32", {shifted, word(31u << 23)});
  return e.value("or.b32", {sign, e.select(large, special, e.select(small, subnormal, normal))});
}

}  // namespace

Operands pack_unorm_4x8(Emitter& e, const Arguments& x) { return pack_normalised(e, x[0], 8, false); }
Operands pack_snorm_4x8(Emitter& e, const Arguments& x) { return pack_normalised(e, x[0], 8, true); }
Operands pack_unorm_2x16(Emitter& e, const Arguments& x) { return pack_normalised(e, x[0], 16, false); }
Operands pack_snorm_2x16(Emitter& e, const Arguments& x) { return pack_normalised(e, x[0], 16, true); }
Operands pack_half_2x16(Emitter& e, const Arguments& x) {
  return join(e, {to_half(e, x[0][0]), to_half(e, x[0][1])}, 16);
}
Operands unpack_unorm_4x8(Emitter& e, const Arguments& x) { return unpack_normalised(e, x[0][0], 8, false); }
Operands unpack_snorm_4x8(Emitter& e, const Arguments& x) { return unpack_normalised(e, x[0][0], 8, true); }
Operands unpack_unorm_2x16(Emitter& e, const Arguments& x) { return unpack_normalised(e, x[0][0], 16, false); }
Operands unpack_snorm_2x16(Emitter& e, const Arguments& x) { return unpack_normalised(e, x[0][0], 16, true); }
Operands unpack_half_2x16(Emitter& e, const Arguments& x) {
  return {from_half(e, x[0][0], 0), from_half(e, x[0][0], 16)};
}

}  // namespace glint::frontend::pack
