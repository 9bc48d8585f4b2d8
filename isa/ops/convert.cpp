// Conversions between integers and floats, and rounding to integers.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

inline float with_sign_of(float magnitude, float x) {
  return float_of((float_bits(magnitude) & 0x7fff'ffffu) | (float_bits(x) & 0x8000'0000u));
}
inline float round_down(float x) {
  const float r = round_even(x);
  return canonical(with_sign_of(r > x ? r - 1.0f : r, x));
}
inline float round_up(float x) {
  const float r = round_even(x);
  return canonical(with_sign_of(r < x ? r + 1.0f : r, x));
}
inline float round_to_zero(float x) {
  const float magnitude = float_of(float_bits(x) & 0x7fff'ffffu);
  const float r = round_even(magnitude);
  return canonical(with_sign_of(r > magnitude ? r - 1.0f : r, x));
}

// The cast happens only to values in range: outside C++ leaves it undefined, and hosts differ.
inline int32_t to_signed(float x) {
  const bool in_range = x >= -2147483648.0f && x < 2147483648.0f;
  const int32_t inside = int32_t(in_range ? x : 0.0f);
  const int32_t clipped = x >= 2147483648.0f ? 0x7fff'ffff : inside;
  return x < -2147483648.0f ? int32_t(0x8000'0000u) : clipped;
}
inline uint32_t to_unsigned(float x) {
  const bool in_range = x >= 0.0f && x < 4294967296.0f;
  const uint32_t inside = uint32_t(in_range ? x : 0.0f);
  return x >= 4294967296.0f ? ~0u : inside;
}

constexpr OpRow kRows[] = {
    value_op<uint32_t>("cvt.u64.u32", Unit::Int, "Widens with zeros.", [](uint32_t a) { return uint64_t(a); },
                       {{{7}, 7}, {{0xffff'ffff}, 0xffff'ffff}}),
    value_op<int32_t>("cvt.s64.s32", Unit::Int, "Widens with copies of the sign.",
                      [](int32_t a) { return int64_t(a); }, {{{7}, 7}, {{0xffff'ffff}, ~0ull}}),
    value_op<uint64_t>("cvt.u32.u64", Unit::Int, "Keeps the low half.",
                       [](uint64_t a) { return uint32_t(a); }, {{{7}, 7}, {{0x1'0000'0002}, 2}}),
    unary<float>("cvt.rni.f32.f32", Unit::Sfu, "Rounds to the nearest integer, ties to even.",
                 [](float a) { return round_even(a); },
                 {{{0x3f00'0000}, 0},
                  {{0xbf00'0000}, 0x8000'0000},
                  {{0x4020'0000}, 0x4000'0000},
                  {{0x7f80'0001}, 0x7fff'ffff},
                  {{0x8000'0001}, 0x8000'0000},
                  {{0x4b00'0001}, 0x4b00'0001}}),
    unary<float>("cvt.rmi.f32.f32", Unit::Sfu, "Rounds to the next integer below.",
                 [](float a) { return round_down(a); },
                 {{{0xbf00'0000}, 0xbf80'0000},
                  {{0x3f00'0000}, 0},
                  {{0x8000'0000}, 0x8000'0000},
                  {{0x8000'0001}, 0xbf80'0000},
                  {{0x7f80'0000}, 0x7f80'0000}}),
    unary<float>("cvt.rpi.f32.f32", Unit::Sfu, "Rounds to the next integer above.",
                 [](float a) { return round_up(a); },
                 {{{0xbf00'0000}, 0x8000'0000},
                  {{0x3f00'0000}, 0x3f80'0000},
                  {{1}, 0x3f80'0000},
                  {{0x7fc0'0000}, 0x7fff'ffff}}),
    unary<float>("cvt.rzi.f32.f32", Unit::Sfu, "Rounds to the next integer towards 0.",
                 [](float a) { return round_to_zero(a); },
                 {{{0xbff0'0000}, 0xbf80'0000},
                  {{0x3ff0'0000}, 0x3f80'0000},
                  {{0xbf00'0000}, 0x8000'0000},
                  {{0xff80'0000}, 0xff80'0000}}),
    value_op<float>("cvt.rzi.s32.f32", Unit::Sfu, "Converts towards 0; saturates, NaN gives 0.",
                    [](float a) { return to_signed(a); },
                    {{{0xbfc0'0000}, 0xffff'ffff},
                     {{0x7fc0'0000}, 0},
                     {{0x7f80'0000}, 0x7fff'ffff},
                     {{0xd015'02f9}, 0x8000'0000},
                     {{0xcf00'0000}, 0x8000'0000},
                     {{0x4f00'0000}, 0x7fff'ffff}}),
    value_op<float>("cvt.rzi.u32.f32", Unit::Sfu, "Converts towards 0; saturates, NaN gives 0.",
                    [](float a) { return to_unsigned(a); },
                    {{{0xbf80'0000}, 0},
                     {{0x7fc0'0000}, 0},
                     {{0x5015'02f9}, 0xffff'ffff},
                     {{0x4f7f'ffff}, 0xffff'ff00},
                     {{0x4f80'0000}, 0xffff'ffff}}),
    value_op<int32_t>("cvt.rn.f32.s32", Unit::Int, "Converts, rounding to nearest even.",
                      [](int32_t a) { return float(a); },
                      {{{1}, 0x3f80'0000},
                       {{0x8000'0000}, 0xcf00'0000},
                       {{0x0100'0001}, 0x4b80'0000},
                       {{0x7fff'ffff}, 0x4f00'0000}}),
    value_op<uint32_t>("cvt.rn.f32.u32", Unit::Int, "Converts, rounding to nearest even.",
                       [](uint32_t a) { return float(a); },
                       {{{1}, 0x3f80'0000},
                        {{0x8000'0000}, 0x4f00'0000},
                        {{0x0100'0003}, 0x4b80'0002},
                        {{0xffff'ffff}, 0x4f80'0000}}),
};

}  // namespace

RowList convert_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
