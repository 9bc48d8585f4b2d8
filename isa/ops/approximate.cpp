// Special functions as the hardware approximates them, and those of GLSL.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr OpRow kRows[] = {
    unary<float>("rsqrt.f32", Unit::Sfu, "Reciprocal square root, within 0.51 ulp.",
                 [](float a) { return exact_rsqrt(a); },
                 {{{0x4080'0000}, 0x3f00'0000},
                  {{0x8000'0000}, 0xff80'0000},
                  {{0x7f80'0000}, 0},
                  {{0x8000'0001}, 0x7fff'ffff}}),
    unary<float>("sin.f32", Unit::Sfu, "Sine of radians, within 0.51 ulp below 2^48 and 0 beyond.",
                 [](float a) { return exact_sin(a); },
                 {{{0}, 0},
                  {{0x8000'0000}, 0x8000'0000},
                  {{0x3f80'0000}, 0x3f57'6aa4},
                  {{0x7f80'0000}, 0x7fff'ffff},
                  {{0x7f00'0000}, 0}}),
    unary<float>("cos.f32", Unit::Sfu, "Cosine of radians, within 0.51 ulp below 2^48 and 1 beyond.",
                 [](float a) { return exact_cos(a); },
                 {{{0}, 0x3f80'0000},
                  {{0x8000'0000}, 0x3f80'0000},
                  {{0x3f80'0000}, 0x3f0a'5140},
                  {{0x7fc0'0000}, 0x7fff'ffff}}),
    unary<float>("ex2.f32", Unit::Sfu, "2 to the power, within 0.51 ulp.",
                 [](float a) { return exact_ex2(a); },
                 {{{0}, 0x3f80'0000},
                  {{0x3f80'0000}, 0x4000'0000},
                  {{0xff80'0000}, 0},
                  {{0xc315'0000}, 1},
                  {{0xc316'0000}, 0},
                  {{0x4300'0000}, 0x7f80'0000},
                  {{0x7fc0'0000}, 0x7fff'ffff}}),
    unary<float>("lg2.f32", Unit::Sfu, "Base-2 logarithm, within 0.51 ulp.",
                 [](float a) { return exact_lg2(a); },
                 {{{0x3f80'0000}, 0},
                  {{0x4100'0000}, 0x4040'0000},
                  {{0x8000'0000}, 0xff80'0000},
                  {{1}, 0xc315'0000},
                  {{0xbf80'0000}, 0x7fff'ffff},
                  {{0x7f80'0000}, 0x7f80'0000}}),
};

}  // namespace

RowList approximate_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
