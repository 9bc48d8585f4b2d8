// Packs and unpacks floats with the formulas of GLSL 4.60, 8.4 "Floating-Point Pack and Unpack Functions".
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/pack.h"

#include <cstdint>

namespace glint::frontend::pack {
namespace {

// Joins fields of `width` bits, the first in the lowest bits. The bits above a field must be 0.
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
    // NaN becomes 1 in signed formats and 0 in unsigned ones, as on hardware, because min and max return the
    // other operand.
    const Operand clamped = is_signed
                                ? e.value("max.f32", {e.value("min.f32", {part, constant_f32(1)}), low})
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
    // The ratio is never above 1.
    result.push_back(is_signed ? e.value("max.f32", {ratio, constant_f32(-1)}) : ratio);
  }
  return result;
}

}  // namespace

Operands pack_unorm_4x8(Emitter& e, const Arguments& x) {
  return pack_normalised(e, x[0], 8, false);
}
Operands pack_snorm_4x8(Emitter& e, const Arguments& x) {
  return pack_normalised(e, x[0], 8, true);
}
Operands pack_unorm_2x16(Emitter& e, const Arguments& x) {
  return pack_normalised(e, x[0], 16, false);
}
Operands pack_snorm_2x16(Emitter& e, const Arguments& x) {
  return pack_normalised(e, x[0], 16, true);
}
Operands pack_half_2x16(Emitter& e, const Arguments& x) {
  return join(e, {e.value("cvt.rn.f16.f32", {x[0][0]}), e.value("cvt.rn.f16.f32", {x[0][1]})}, 16);
}
Operands unpack_unorm_4x8(Emitter& e, const Arguments& x) {
  return unpack_normalised(e, x[0][0], 8, false);
}
Operands unpack_snorm_4x8(Emitter& e, const Arguments& x) {
  return unpack_normalised(e, x[0][0], 8, true);
}
Operands unpack_unorm_2x16(Emitter& e, const Arguments& x) {
  return unpack_normalised(e, x[0][0], 16, false);
}
Operands unpack_snorm_2x16(Emitter& e, const Arguments& x) {
  return unpack_normalised(e, x[0][0], 16, true);
}
Operands unpack_half_2x16(Emitter& e, const Arguments& x) {
  const Operand upper = e.value("shr.u32", {x[0][0], word(16)});
  return {e.value("cvt.f32.f16", {x[0][0]}), e.value("cvt.f32.f16", {upper})};
}

}  // namespace glint::frontend::pack
