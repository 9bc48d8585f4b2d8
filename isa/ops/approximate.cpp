// Defines special functions as the hardware approximates them, and those of GLSL.
// SPDX-License-Identifier: Apache-2.0
#include "isa/approximate.h"

#include "isa/half.h"
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Turns subnormals into zeros of their sign.
[[gnu::always_inline]] inline float flushed(float x) {
  const uint32_t bits = float_bits(x);
  return float_of((bits & kInfinityBits) == 0 ? bits & kSignMask : bits);
}
[[gnu::always_inline]] inline bool is_below(float x, float limit) {
  return __builtin_fabsf(x) < limit;
}
inline constexpr float kSmallestNormal = 0x1p-126f;

// Without .ftz, the driver's code scales arguments into the unit's range, and scales the results back.
[[gnu::always_inline]] inline float scaled_rcp(float a) {
  const float scale = is_below(a, kSmallestNormal) ? 0x1p24f : is_below(a, 0x1p126f) ? 1.0f : 0.25f;
  return canonical(unit_rcp(a * scale) * scale);
}
[[gnu::always_inline]] inline float scaled_rsqrt(float a) {
  const bool is_small = is_below(a, kSmallestNormal);
  return canonical(unit_rsqrt(is_small ? a * 0x1p24f : a) * (is_small ? 0x1p12f : 1.0f));
}
[[gnu::always_inline]] inline float scaled_sqrt(float a) {
  const bool is_small = is_below(a, kSmallestNormal);
  return canonical(unit_sqrt(is_small ? a * 0x1p24f : a) * (is_small ? 0x1p-12f : 1.0f));
}
[[gnu::always_inline]] inline float scaled_lg2(float a) {
  const bool is_small = is_below(a, kSmallestNormal);
  return canonical(unit_lg2(is_small ? a * 0x1p24f : a) - (is_small ? 24.0f : 0.0f));
}
[[gnu::always_inline]] inline float scaled_ex2(float a) {
  const bool is_small = a < -126.0f;
  const float root = unit_ex2(is_small ? a * 0.5f : a);
  return canonical(is_small ? root * root : root);
}

// Computes quotients as a times the unit's reciprocal of b.
[[gnu::always_inline]] inline float approximate_quotient(float a, float b) {
  const float scale = is_below(b, kSmallestNormal) ? 0x1p24f : 1.0f;
  return canonical(a * scale * unit_rcp(b * scale));
}
[[gnu::always_inline]] inline float approximate_quotient_ftz(float a, float b) {
  return canonical(flushed(flushed(a) * unit_rcp(b)));
}
[[gnu::always_inline]] inline float full_quotient(float a, float b) {
  const float scale = is_below(b, kSmallestNormal) ? 0x1p24f : is_below(b, 0x1p126f) ? 1.0f : 0.25f;
  return canonical(a * scale * unit_rcp(b * scale));
}
[[gnu::always_inline]] inline float full_quotient_ftz(float a, float b) {
  const float scale = is_below(b, 0x1p126f) ? 1.0f : 0.25f;
  return canonical(flushed(flushed(flushed(a) * scale) * unit_rcp(flushed(b) * scale)));
}

// Follows the driver's code: the unit's estimate, accurate to 2^-20, and one step of third order.
[[gnu::always_inline]] inline double refined_rsqrt(double a) {
  const uint64_t bits = double_bits(a), magnitude = bits & ~kSignMask64;
  const bool is_small = magnitude < 0x0010'0000'0000'0000ull;
  const double x = is_small ? a * 0x1p54 : a;
  const double y = unit_rsqrt64(x);
  const double error = __builtin_fma(x, -(y * y), 1.0);
  const double step = __builtin_fma(error, 0.375, 0.5);
  const double refined = __builtin_fma(step, error * y, y) * (is_small ? 0x1p27 : 1.0);
  uint64_t out = double_bits(refined);
  out = bits > kSignMask64 ? 0xfff8'0000'0000'0000ull : out;
  out = bits == kInfinityBits64 ? 0 : out;
  out = magnitude == 0 ? kInfinityBits64 | bits : out;
  return double_of(magnitude > kInfinityBits64 ? bits | 0x0008'0000'0000'0000ull : out);
}

constexpr OpRow kFloatRows[] = {
    unary<float>(
        "rcp.approx.ftz.f32", Unit::Sfu,
        "Computes the reciprocal by the unit's table, within 1 ulp. Subnormals count as 0.",
        [](float a) { return unit_rcp(a); },
        {{{0x4040'0000}, 0x3eaa'aaab}, {{1}, 0x7f80'0000}, {{0xff80'0000}, 0x8000'0000}, {{0x7f7f'ffff}, 0}}),
    unary<float>("rcp.approx.f32", Unit::Sfu, "Computes the reciprocal by the unit's table, within 1 ulp.",
                 [](float a) { return scaled_rcp(a); },
                 {{{0x4040'0000}, 0x3eaa'aaab}, {{0x8000'0001}, 0xff80'0000}, {{0x7f7f'ffff}, 0x0020'0000}}),
    unary<float>("sqrt.approx.ftz.f32", Unit::Sfu,
                 "Computes the square root by the unit's table, within 1 ulp. Subnormals count as 0.",
                 [](float a) { return unit_sqrt(a); },
                 {{{0x4040'0000}, 0x3fdd'b3d7}, {{0x8000'0001}, 0x8000'0000}, {{0xbf80'0000}, 0x7fff'ffff}}),
    unary<float>("sqrt.approx.f32", Unit::Sfu, "Computes the square root by the unit's table, within 1 ulp.",
                 [](float a) { return scaled_sqrt(a); },
                 {{{0x4040'0000}, 0x3fdd'b3d7}, {{1}, 0x1a35'04f3}, {{0x8000'0001}, 0x7fff'ffff}}),
    unary<float>(
        "rsqrt.approx.ftz.f32", Unit::Sfu,
        "Computes the reciprocal square root by the unit's table, within 1.6 ulp. Subnormals count as 0.",
        [](float a) { return unit_rsqrt(a); },
        {{{0x4040'0000}, 0x3f13'cd3a}, {{0x8000'0001}, 0xff80'0000}, {{0xbf80'0000}, 0x7fff'ffff}}),
    unary<float>("rsqrt.approx.f32", Unit::Sfu,
                 "Computes the reciprocal square root by the unit's table, within 1.6 ulp.",
                 [](float a) { return scaled_rsqrt(a); },
                 {{{0x4040'0000}, 0x3f13'cd3a}, {{1}, 0x64b5'04f2}, {{0x8000'0001}, 0x7fff'ffff}}),
    unary<float>(
        "sin.approx.ftz.f32", Unit::Sfu,
        "Computes the sine of radians by the unit's table, from x / (2 pi) cut to 25 bits after the point.",
        [](float a) { return unit_sine(a, 0); },
        {{{0x3f80'0000}, 0x3f57'6aa3}, {{0x4049'0fdb}, 0}, {{0x8000'0000}, 0x8000'0000}}),
    unary<float>(
        "sin.approx.f32", Unit::Sfu,
        "Computes the sine of radians by the unit's table, from x / (2 pi) cut to 25 bits after the point.",
        [](float a) { return unit_sine(a, 0); },
        {{{0x47cd'e32e}, 0x3f79'c79e}, {{0x7f80'0000}, 0x7fff'ffff}}),
    unary<float>(
        "cos.approx.ftz.f32", Unit::Sfu,
        "Computes the cosine of radians by the unit's table, from x / (2 pi) cut to 25 bits after the point.",
        [](float a) { return unit_sine(a, 1); },
        {{{0x3f80'0000}, 0x3f0a'5141}, {{0x4049'0fdb}, 0xbf80'0000}, {{0x8000'0000}, 0x3f80'0000}}),
    unary<float>(
        "cos.approx.f32", Unit::Sfu,
        "Computes the cosine of radians by the unit's table, from x / (2 pi) cut to 25 bits after the point.",
        [](float a) { return unit_sine(a, 1); },
        {{{0x47cd'e32e}, 0x3e60'5c0e}, {{0x7f80'0000}, 0x7fff'ffff}}),
    unary<float>(
        "ex2.approx.ftz.f32", Unit::Sfu,
        "Computes 2 to the power of the source by the unit's table, within 2.1 ulp. Subnormals become 0.",
        [](float a) { return unit_ex2(a); },
        {{{0x3f80'0000}, 0x4000'0000}, {{0x42ff'ff7d}, 0x7f7f'd29e}, {{0xc2fd'0000}, 0}, {{1}, 0x3f80'0000}}),
    unary<float>(
        "ex2.approx.f32", Unit::Sfu,
        "Computes 2 to the power of the source by the unit's table, within 2.1 ulp.",
        [](float a) { return scaled_ex2(a); },
        {{{0x3f80'0000}, 0x4000'0000}, {{0xc2fd'0000}, 0x005a'8279}, {{0xc315'0000}, 1}, {{0xc316'0000}, 0}}),
    unary<float>(
        "lg2.approx.ftz.f32", Unit::Sfu,
        "Computes the base-2 logarithm by the unit's table, within 2^-22. Subnormals count as 0.",
        [](float a) { return unit_lg2(a); },
        {{{0x4040'0000}, 0x3fca'e00d}, {{1}, 0xff80'0000}, {{0x3f80'0000}, 0}, {{0x3f7f'ffff}, 0xb24b'4000}}),
    unary<float>("lg2.approx.f32", Unit::Sfu,
                 "Computes the base-2 logarithm by the unit's table, within 2^-22.",
                 [](float a) { return scaled_lg2(a); },
                 {{{0x7f7f'ffff}, 0x42ff'ffff}, {{1}, 0xc315'0000}, {{0x8000'0001}, 0x7fff'ffff}}),
    unary<float>(
        "tanh.approx.f32", Unit::Sfu,
        "Computes the hyperbolic tangent by the unit's table, within 2^-16. Below 2^-8 it is x itself.",
        [](float a) { return unit_tanh(a); },
        {{{0x3f80'0000}, 0x3f42'f848}, {{1}, 1}, {{0xff80'0000}, 0xbf80'0000}}),
    binary<float>(
        "div.approx.f32", Unit::Sfu,
        "Computes a times the unit's reciprocal of b, which is 0 for b above 2^126.",
        [](float a, float b) { return approximate_quotient(a, b); },
        {{{0x3f80'0000, 0x4040'0000}, 0x3eaa'aaab}, {{1, 1}, 0x3f80'0000}, {{0x3f80'0000, 0x7f7f'ffff}, 0}}),
    binary<float>(
        "div.approx.ftz.f32", Unit::Sfu,
        "Computes a times the unit's reciprocal of b. Subnormals count as 0.",
        [](float a, float b) { return approximate_quotient_ftz(a, b); },
        {{{0x3f80'0000, 0x4040'0000}, 0x3eaa'aaab}, {{1, 1}, 0x7fff'ffff}, {{0x3f80'0000, 0x7f7f'ffff}, 0}}),
    binary<float>("div.full.f32", Unit::Sfu,
                  "Computes the quotient within 2 ulp over the full range, by the unit's reciprocal of b.",
                  [](float a, float b) { return full_quotient(a, b); },
                  {{{0x4040'0000, 0x7f7f'ffff}, 0x0060'0001}, {{1, 1}, 0x3f80'0000}, {{0, 0}, 0x7fff'ffff}}),
    binary<float>("div.full.ftz.f32", Unit::Sfu,
                  "Computes the quotient within 2 ulp, by the unit's reciprocal of b. Subnormals count as 0.",
                  [](float a, float b) { return full_quotient_ftz(a, b); },
                  {{{0x3f80'0000, 0x4040'0000}, 0x3eaa'aaab}, {{1, 1}, 0x7fff'ffff}}),
};

constexpr OpRow kDoubleRows[] = {
    unary<double>("rcp.approx.ftz.f64", Unit::Sfu,
                  "Computes the reciprocal of the high word with 20 bits of mantissa. Subnormals count as 0.",
                  [](double a) { return unit_rcp64(a); },
                  {{{0x4004'0000'0000'0000}, 0x3fd9'9999'0000'0000},
                   {{1}, 0x7ff0'0000'0000'0000},
                   {{0x7ff8'0000'0000'0000}, 0x7fff'ffff'0000'0000}}),
    unary<double>("rsqrt.approx.ftz.f64", Unit::Sfu,
                  "Computes the reciprocal square root of the high word with 20 bits of mantissa. Subnormals "
                  "count as 0.",
                  [](double a) { return unit_rsqrt64(a); },
                  {{{0x4010'0000'0000'0000}, 0x3fe0'0000'0000'0000},
                   {{0x0010'0000'0000'0000}, 0x5fe0'0000'0000'0000},
                   {{0xbff0'0000'0000'0000}, 0x7fff'ffff'0000'0000}}),
    unary<double>("rsqrt.approx.f64", Unit::Fp64Div, "Computes the reciprocal square root, within 1 ulp.",
                  [](double a) { return refined_rsqrt(a); },
                  {{{0x4010'0000'0000'0000}, 0x3fe0'0000'0000'0000},
                   {{1}, 0x6180'0000'0000'0000},
                   {{0xbff0'0000'0000'0000}, 0xfff8'0000'0000'0000}}),
};

// The 16-bit forms cut the unit's result for the widened argument.
template <auto kUnit>
struct OfHalf {
  // Handles the half in the upper 16 bits of a word.
  [[gnu::always_inline]] static uint32_t of_upper(uint32_t word) {
    return cut_to_half(kUnit(float_of_upper_half(word)));
  }
  [[gnu::always_inline]] Half operator()(Half a) const {
    return {uint16_t(of_upper(uint32_t(a.bits) << 16))};
  }
};
template <auto kUnit>
struct OfBfloat {
  [[gnu::always_inline]] static uint32_t of_upper(uint32_t word) {
    return cut_to_bfloat(kUnit(float_of(word & 0xffff'0000)));
  }
  [[gnu::always_inline]] Bfloat operator()(Bfloat a) const {
    return {uint16_t(of_upper(uint32_t(a.bits) << 16))};
  }
};
template <class Of>
struct OfPair {
  [[gnu::always_inline]] uint32_t operator()(uint32_t a) const {
    return Of::of_upper(a << 16) | Of::of_upper(a) << 16;
  }
};

constexpr OpRow kHalfRows[] = {
    unary<Half>("ex2.approx.f16", Unit::Sfu,
                "Computes 2 to the power of the source by the unit's table, and cuts the result.",
                OfHalf<unit_ex2>{},
                {{{0x3c00}, 0x4000}, {{0x83ff}, 0x3bff}, {{0xfc00}, 0}, {{0x7e00}, 0x7fff}}),
    unary<uint32_t>("ex2.approx.f16x2", Unit::Sfu,
                    "Computes 2 to the power of both halves by the unit's table, and cuts the results.",
                    OfPair<OfHalf<unit_ex2>>{}, {{{0x83ff'3c00}, 0x3bff'4000}, {{0x7e00'fc00}, 0x7fff'0000}}),
    unary<Half>("tanh.approx.f16", Unit::Sfu,
                "Computes the hyperbolic tangent by the unit's table, and cuts the result.",
                OfHalf<unit_tanh>{},
                {{{0x3c00}, 0x3a17}, {{0x8001}, 0x8001}, {{0xfc00}, 0xbc00}, {{0x7e00}, 0x7fff}}),
    unary<uint32_t>(
        "tanh.approx.f16x2", Unit::Sfu,
        "Computes the hyperbolic tangent of both halves by the unit's table, and cuts the results.",
        OfPair<OfHalf<unit_tanh>>{}, {{{0x8001'3c00}, 0x8001'3a17}, {{0x7e00'fc00}, 0x7fff'bc00}}),
    unary<Bfloat>("ex2.approx.ftz.bf16", Unit::Sfu,
                  "Computes 2 to the power of the source by the unit's table, and cuts the result.",
                  OfBfloat<unit_ex2>{},
                  {{{0x3f80}, 0x4000}, {{0xbf80}, 0x3f00}, {{0xff80}, 0}, {{0x7fc0}, 0x7fff}}),
    unary<uint32_t>("ex2.approx.ftz.bf16x2", Unit::Sfu,
                    "Computes 2 to the power of both bfloats by the unit's table, and cuts the results.",
                    OfPair<OfBfloat<unit_ex2>>{},
                    {{{0xbf80'3f80}, 0x3f00'4000}, {{0x7fc0'ff80}, 0x7fff'0000}}),
    unary<Bfloat>("tanh.approx.bf16", Unit::Sfu,
                  "Computes the hyperbolic tangent by the unit's table, and cuts the result.",
                  OfBfloat<unit_tanh>{},
                  {{{0x3f80}, 0x3f42}, {{0x8001}, 0x8001}, {{0xff80}, 0xbf80}, {{0x7fc0}, 0x7fff}}),
    unary<uint32_t>(
        "tanh.approx.bf16x2", Unit::Sfu,
        "Computes the hyperbolic tangent of both bfloats by the unit's table, and cuts the results.",
        OfPair<OfBfloat<unit_tanh>>{}, {{{0x8001'3f80}, 0x8001'3f42}, {{0x7fc0'ff80}, 0x7fff'bf80}}),
};

constexpr OpRow kExactRows[] = {
    unary<float>("rsqrt.f32", Unit::Sfu, "Computes the reciprocal square root, within 0.51 ulp.",
                 [](float a) { return exact_rsqrt(a); },
                 {{{0x4080'0000}, 0x3f00'0000},
                  {{0x8000'0000}, 0xff80'0000},
                  {{0x7f80'0000}, 0},
                  {{0x8000'0001}, 0x7fff'ffff}}),
    unary<float>("sin.f32", Unit::Sfu,
                 "Computes the sine of radians, within 0.51 ulp below 2^48. From there on it is 0.",
                 [](float a) { return exact_sin(a); },
                 {{{0}, 0},
                  {{0x8000'0000}, 0x8000'0000},
                  {{0x3f80'0000}, 0x3f57'6aa4},
                  {{0x7f80'0000}, 0x7fff'ffff},
                  {{0x7f00'0000}, 0}}),
    unary<float>("cos.f32", Unit::Sfu,
                 "Computes the cosine of radians, within 0.51 ulp below 2^48. From there on it is 1.",
                 [](float a) { return exact_cos(a); },
                 {{{0}, 0x3f80'0000},
                  {{0x8000'0000}, 0x3f80'0000},
                  {{0x3f80'0000}, 0x3f0a'5140},
                  {{0x7fc0'0000}, 0x7fff'ffff}}),
    unary<float>("ex2.f32", Unit::Sfu, "Computes 2 to the power of the source, within 0.51 ulp.",
                 [](float a) { return exact_ex2(a); },
                 {{{0}, 0x3f80'0000},
                  {{0x3f80'0000}, 0x4000'0000},
                  {{0xff80'0000}, 0},
                  {{0xc315'0000}, 1},
                  {{0xc316'0000}, 0},
                  {{0x4300'0000}, 0x7f80'0000},
                  {{0x7fc0'0000}, 0x7fff'ffff}}),
    unary<float>("lg2.f32", Unit::Sfu, "Computes the base-2 logarithm, within 0.51 ulp.",
                 [](float a) { return exact_lg2(a); },
                 {{{0x3f80'0000}, 0},
                  {{0x4100'0000}, 0x4040'0000},
                  {{0x8000'0000}, 0xff80'0000},
                  {{1}, 0xc315'0000},
                  {{0xbf80'0000}, 0x7fff'ffff},
                  {{0x7f80'0000}, 0x7f80'0000}}),
};

// Joins the rows one after the other.
constexpr auto kRows = [] {
  std::array<OpRow,
             std::size(kFloatRows) + std::size(kDoubleRows) + std::size(kHalfRows) + std::size(kExactRows)>
      out;
  size_t n = 0;
  const auto append = [&](const auto& rows) {
    for (const OpRow& row : rows) out[n++] = row;
  };
  append(kFloatRows), append(kDoubleRows), append(kHalfRows), append(kExactRows);
  return out;
}();

}  // namespace

RowList approximate_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
