// Single-precision arithmetic, special functions and comparisons: IEEE 754, subnormals kept.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// min and max on the bits: signed integers in two's complement order like the floats, -0 before +0.
inline int32_t ordered(float x) {
  const int32_t bits = int32_t(float_bits(x));
  return bits ^ ((bits >> 31) & 0x7fff'ffff);
}
inline float minimum(float a, float b) {
  const float smaller = ordered(a) < ordered(b) ? a : b;
  const float number = is_nan(a) ? b : smaller;
  return canonical(is_nan(b) ? a : number);
}
inline float maximum(float a, float b) {
  const float larger = ordered(a) > ordered(b) ? a : b;
  const float number = is_nan(a) ? b : larger;
  return canonical(is_nan(b) ? a : number);
}

constexpr OpRow kRows[] = {
    binary<float>("add.rn.f32", Unit::Fp32, "Adds.", [](float a, float b) { return canonical(a + b); },
                  {{{0x3f80'0000, 0x3f80'0000}, 0x4000'0000},
                   {{1, 1}, 2},
                   {{0x7f80'0000, 0xff80'0000}, 0x7fff'ffff},
                   {{0x7fc0'0000, 1}, 0x7fff'ffff},
                   {{0x7f7f'ffff, 0x7f7f'ffff}, 0x7f80'0000},
                   {{0x8000'0000, 0}, 0}}),
    binary<float>(
        "sub.rn.f32", Unit::Fp32, "Subtracts.", [](float a, float b) { return canonical(a - b); },
        {{{0x3f80'0000, 0x3f80'0000}, 0}, {{1, 2}, 0x8000'0001}, {{0x7f80'0000, 0x7f80'0000}, 0x7fff'ffff}}),
    binary<float>("mul.rn.f32", Unit::Fp32, "Multiplies.", [](float a, float b) { return canonical(a * b); },
                  {{{0x4000'0000, 0x4040'0000}, 0x40c0'0000},
                   {{0x0080'0000, 0x3f00'0000}, 0x0040'0000},
                   {{1, 1}, 0},
                   {{0, 0x7f80'0000}, 0x7fff'ffff},
                   {{0x8000'0000, 0x8000'0000}, 0}}),
    binary<float>("div.rn.f32", Unit::FpDiv, "Divides.", [](float a, float b) { return canonical(a / b); },
                  {{{0x3f80'0000, 0x4040'0000}, 0x3eaa'aaab},
                   {{0x3f80'0000, 0x8000'0000}, 0xff80'0000},
                   {{0, 0}, 0x7fff'ffff},
                   {{1, 0x4000'0000}, 0},
                   {{3, 0x4000'0000}, 2}}),
    binary<float>("min.f32", Unit::Fp32,
                  "The smaller; a NaN loses against a number, and -0 counts as less than +0.",
                  [](float a, float b) { return minimum(a, b); },
                  {{{0x7fc0'0000, 0x3f80'0000}, 0x3f80'0000},
                   {{0x3f80'0000, 0x7f80'0001}, 0x3f80'0000},
                   {{0x7fc0'0000, 0x7fc0'0000}, 0x7fff'ffff},
                   {{0, 0x8000'0000}, 0x8000'0000},
                   {{0x8000'0000, 0}, 0x8000'0000},
                   {{1, 0x8000'0001}, 0x8000'0001}}),
    binary<float>("max.f32", Unit::Fp32,
                  "The larger; a NaN loses against a number, and +0 counts as more than -0.",
                  [](float a, float b) { return maximum(a, b); },
                  {{{0x7fc0'0000, 0x3f80'0000}, 0x3f80'0000},
                   {{0x3f80'0000, 0x7f80'0001}, 0x3f80'0000},
                   {{0x7fc0'0000, 0x7fc0'0000}, 0x7fff'ffff},
                   {{0, 0x8000'0000}, 0},
                   {{0x8000'0000, 0}, 0},
                   {{1, 0x8000'0001}, 1}}),
    binary<uint32_t>("copysign.f32", Unit::Int,
                     "The second source with the sign of the first (the order of PTX).",
                     [](uint32_t a, uint32_t b) { return (a & 0x8000'0000u) | (b & 0x7fff'ffffu); },
                     {{{0x3f80'0000, 0x8000'0000}, 0}, {{0x8000'0000, 0x3f80'0000}, 0xbf80'0000}}),
    ternary<float>("fma.rn.f32", Unit::Fp32, "Multiplies and adds, rounded once.",
                   [](float a, float b, float c) { return canonical(__builtin_fmaf(a, b, c)); },
                   {{{0x3f80'0001, 0x3f80'0001, 0xbf80'0000}, 0x3480'0000},
                    {{0x7f80'0000, 0, 0}, 0x7fff'ffff},
                    {{0x7f80'0000, 0x3f80'0000, 0xff80'0000}, 0x7fff'ffff},
                    {{1, 0x3f80'0000, 1}, 2}}),
    unary<float>(
        "neg.f32", Unit::Fp32, "Negates.", [](float a) { return canonical(-a); },
        {{{0x3f80'0000}, 0xbf80'0000}, {{0}, 0x8000'0000}, {{0x7fc0'0000}, 0x7fff'ffff}, {{1}, 0x8000'0001}}),
    unary<float>(
        "abs.f32", Unit::Fp32, "Magnitude.",
        [](float a) { return canonical(float_of(float_bits(a) & 0x7fff'ffffu)); },
        {{{0xbf80'0000}, 0x3f80'0000}, {{0x8000'0000}, 0}, {{0xffc0'0000}, 0x7fff'ffff}, {{0x8000'0001}, 1}}),
    unary<float>("sqrt.rn.f32", Unit::FpDiv, "Square root.",
                 [](float a) { return canonical(__builtin_sqrtf(a)); },
                 {{{0x4080'0000}, 0x4000'0000},
                  {{0x8000'0000}, 0x8000'0000},
                  {{0xbf80'0000}, 0x7fff'ffff},
                  {{1}, 0x1a35'04f3}}),
    unary<float>(
        "rcp.rn.f32", Unit::FpDiv, "Reciprocal.", [](float a) { return canonical(1.0f / a); },
        {{{0x4040'0000}, 0x3eaa'aaab}, {{0x8000'0000}, 0xff80'0000}, {{0x7f80'0000}, 0}, {{1}, 0x7f80'0000}}),
    unary<uint32_t>("testp.finite.f32", Unit::Fp32, "True for numbers that are not infinite.",
                    [](uint32_t a) { return (a & 0x7fff'ffffu) < 0x7f80'0000u; },
                    {{{0x7f7f'ffff}, 1}, {{0x7f80'0000}, 0}, {{0x7fc0'0000}, 0}, {{1}, 1}}),
    unary<uint32_t>("testp.infinite.f32", Unit::Fp32, "True for the infinities.",
                    [](uint32_t a) { return (a & 0x7fff'ffffu) == 0x7f80'0000u; },
                    {{{0x7f7f'ffff}, 0}, {{0xff80'0000}, 1}, {{0x7fc0'0000}, 0}}),
    unary<uint32_t>("testp.notanumber.f32", Unit::Fp32, "True for NaN.",
                    [](uint32_t a) { return (a & 0x7fff'ffffu) > 0x7f80'0000u; },
                    {{{0x7f80'0000}, 0}, {{0x7f80'0001}, 1}, {{0xffc0'0000}, 1}}),
    binary<float>("setp.eq.f32", Unit::Fp32, "True where a == b; false with a NaN.",
                  [](float a, float b) { return a == b; },
                  {{{0x3f80'0000, 0x4000'0000}, 0},
                   {{0x4000'0000, 0x3f80'0000}, 0},
                   {{0, 0x8000'0000}, 1},
                   {{0x7fc0'0000, 0x3f80'0000}, 0},
                   {{0x7fc0'0000, 0x7fc0'0000}, 0}}),
    binary<float>("setp.equ.f32", Unit::Fp32, "True where a == b or one is a NaN.",
                  [](float a, float b) { return !(a < b || a > b); },
                  {{{0x3f80'0000, 0x4000'0000}, 0},
                   {{0x4000'0000, 0x3f80'0000}, 0},
                   {{0, 0x8000'0000}, 1},
                   {{0x7fc0'0000, 0x3f80'0000}, 1},
                   {{0x7fc0'0000, 0x7fc0'0000}, 1}}),
    binary<float>("setp.ne.f32", Unit::Fp32, "True where a != b; false with a NaN.",
                  [](float a, float b) { return a < b || a > b; },
                  {{{0x3f80'0000, 0x4000'0000}, 1},
                   {{0x4000'0000, 0x3f80'0000}, 1},
                   {{0, 0x8000'0000}, 0},
                   {{0x7fc0'0000, 0x3f80'0000}, 0},
                   {{0x7fc0'0000, 0x7fc0'0000}, 0}}),
    binary<float>("setp.neu.f32", Unit::Fp32, "True where a != b or one is a NaN.",
                  [](float a, float b) { return !(a == b); },
                  {{{0x3f80'0000, 0x4000'0000}, 1},
                   {{0x4000'0000, 0x3f80'0000}, 1},
                   {{0, 0x8000'0000}, 0},
                   {{0x7fc0'0000, 0x3f80'0000}, 1},
                   {{0x7fc0'0000, 0x7fc0'0000}, 1}}),
    binary<float>("setp.lt.f32", Unit::Fp32, "True where a < b; false with a NaN.",
                  [](float a, float b) { return a < b; },
                  {{{0x3f80'0000, 0x4000'0000}, 1},
                   {{0x4000'0000, 0x3f80'0000}, 0},
                   {{0, 0x8000'0000}, 0},
                   {{0x7fc0'0000, 0x3f80'0000}, 0},
                   {{0x7fc0'0000, 0x7fc0'0000}, 0}}),
    binary<float>("setp.ltu.f32", Unit::Fp32, "True where a < b or one is a NaN.",
                  [](float a, float b) { return !(a >= b); },
                  {{{0x3f80'0000, 0x4000'0000}, 1},
                   {{0x4000'0000, 0x3f80'0000}, 0},
                   {{0, 0x8000'0000}, 0},
                   {{0x7fc0'0000, 0x3f80'0000}, 1},
                   {{0x7fc0'0000, 0x7fc0'0000}, 1}}),
    binary<float>("setp.le.f32", Unit::Fp32, "True where a <= b; false with a NaN.",
                  [](float a, float b) { return a <= b; },
                  {{{0x3f80'0000, 0x4000'0000}, 1},
                   {{0x4000'0000, 0x3f80'0000}, 0},
                   {{0, 0x8000'0000}, 1},
                   {{0x7fc0'0000, 0x3f80'0000}, 0},
                   {{0x7fc0'0000, 0x7fc0'0000}, 0}}),
    binary<float>("setp.leu.f32", Unit::Fp32, "True where a <= b or one is a NaN.",
                  [](float a, float b) { return !(a > b); },
                  {{{0x3f80'0000, 0x4000'0000}, 1},
                   {{0x4000'0000, 0x3f80'0000}, 0},
                   {{0, 0x8000'0000}, 1},
                   {{0x7fc0'0000, 0x3f80'0000}, 1},
                   {{0x7fc0'0000, 0x7fc0'0000}, 1}}),
    binary<float>("setp.gt.f32", Unit::Fp32, "True where a > b; false with a NaN.",
                  [](float a, float b) { return a > b; },
                  {{{0x3f80'0000, 0x4000'0000}, 0},
                   {{0x4000'0000, 0x3f80'0000}, 1},
                   {{0, 0x8000'0000}, 0},
                   {{0x7fc0'0000, 0x3f80'0000}, 0},
                   {{0x7fc0'0000, 0x7fc0'0000}, 0}}),
    binary<float>("setp.gtu.f32", Unit::Fp32, "True where a > b or one is a NaN.",
                  [](float a, float b) { return !(a <= b); },
                  {{{0x3f80'0000, 0x4000'0000}, 0},
                   {{0x4000'0000, 0x3f80'0000}, 1},
                   {{0, 0x8000'0000}, 0},
                   {{0x7fc0'0000, 0x3f80'0000}, 1},
                   {{0x7fc0'0000, 0x7fc0'0000}, 1}}),
    binary<float>("setp.ge.f32", Unit::Fp32, "True where a >= b; false with a NaN.",
                  [](float a, float b) { return a >= b; },
                  {{{0x3f80'0000, 0x4000'0000}, 0},
                   {{0x4000'0000, 0x3f80'0000}, 1},
                   {{0, 0x8000'0000}, 1},
                   {{0x7fc0'0000, 0x3f80'0000}, 0},
                   {{0x7fc0'0000, 0x7fc0'0000}, 0}}),
    binary<float>("setp.geu.f32", Unit::Fp32, "True where a >= b or one is a NaN.",
                  [](float a, float b) { return !(a < b); },
                  {{{0x3f80'0000, 0x4000'0000}, 0},
                   {{0x4000'0000, 0x3f80'0000}, 1},
                   {{0, 0x8000'0000}, 1},
                   {{0x7fc0'0000, 0x3f80'0000}, 1},
                   {{0x7fc0'0000, 0x7fc0'0000}, 1}}),
};

}  // namespace

RowList float_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
