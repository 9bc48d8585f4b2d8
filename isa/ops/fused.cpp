// Defines operations that GPUs do in one instruction and that PTX writes as two.
// SPDX-License-Identifier: Apache-2.0
#include "isa/integer_kernels.h"
#include "isa/op_makers.h"
#include "isa/ops/families.h"
#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr uint32_t kSign = 0x8000'0000, kOne = 0x3f80'0000, kTwo = 0x4000'0000;

template <class N>
constexpr auto order_rows() {
  using T = typename N::Type;
  constexpr uint64_t kOnes = word(T(-1));
  constexpr bool kSigned = std::is_signed_v<T>;
  return joined_rows(
      ternary<T>(joined<"addmin", N::kName>, Unit::Int,
                 "Returns the smaller of the first two sources' sum and the third source.",
                 [](T a, T b, T c) {
                   const T sum = T(Unsigned<T>(a) + Unsigned<T>(b));
                   return sum < c ? sum : c;
                 },
                 {{{1, 2, 5}, 3}, {{kOnes, 0, 7}, kSigned ? kOnes : 7}}),
      ternary<T>(joined<"addmax", N::kName>, Unit::Int,
                 "Returns the larger of the first two sources' sum and the third source.",
                 [](T a, T b, T c) {
                   const T sum = T(Unsigned<T>(a) + Unsigned<T>(b));
                   return sum > c ? sum : c;
                 },
                 {{{1, 2, 5}, 5}, {{kOnes, 0, 7}, kSigned ? 7 : kOnes}}),
      value_op<T, uint32_t, T>(
          joined<"shradd", N::kName>, Unit::Int,
          "Shifts the first source right by the second, as shr does, and adds the third.",
          [](T a, uint32_t n, T b) { return T(Unsigned<T>(shifted_right(a, n)) + Unsigned<T>(b)); },
          {{{13, 2, 4}, 7}, {{kOnes, 31, 1}, kSigned ? 0 : 2}}));
}

constexpr auto kRows = joined_rows(
    ternary<uint32_t>("add3.u32", Unit::Int, "Adds three words.",
                      [](uint32_t a, uint32_t b, uint32_t c) { return a + b + c; },
                      {{{1, 2, 3}, 6}, {{0xffff'ffff, 1, 5}, 5}}),
    ternary<uint32_t>("addsub.u32", Unit::Int, "Adds the first two sources and subtracts the third.",
                      [](uint32_t a, uint32_t b, uint32_t c) { return a + b - c; },
                      {{{1, 2, 3}, 0}, {{0, 0, 1}, 0xffff'ffff}}),
    ternary<uint32_t>("subsub.u32", Unit::Int, "Subtracts the last two sources from the first.",
                      [](uint32_t a, uint32_t b, uint32_t c) { return a - b - c; },
                      {{{6, 2, 3}, 1}, {{0, 1, 1}, 0xffff'fffe}}),
    ternary<float>(
        "fms.rn.f32", Unit::Fp32,
        "Multiplies the first two sources, subtracts the third exactly, and rounds to nearest even.",
        [](float a, float b, float c) { return canonical(__builtin_fmaf(a, b, -c)); },
        {{{kOne, kTwo, kOne}, kOne}, {{0x3f80'0001, 0x3f80'0001, 0x3f80'0002}, 0x2880'0000}}),
    ternary<float>(
        "nfma.rn.f32", Unit::Fp32,
        "Subtracts the product of the first two sources from the third exactly, and rounds to nearest even.",
        [](float a, float b, float c) { return canonical(__builtin_fmaf(-a, b, c)); },
        {{{kOne, kTwo, kOne}, kOne | kSign}, {{0x3f80'0001, 0x3f80'0001, 0x3f80'0002}, 0xa880'0000}}),
    value_op<uint64_t, uint32_t, uint64_t>(
        "shladd.u64", Unit::Int,
        "Shifts the first source left by the second, as shl does, and adds the third.",
        [](uint64_t a, uint32_t n, uint64_t b) { return (n < 64 ? a << n : 0) + b; },
        {{{3, 2, 5}, 17}, {{uint64_t{1} << 63, 1, 9}, 9}}),
    rows_of_types<TypeS32, TypeU32>([]<class N>() { return order_rows<N>(); }));

}  // namespace

RowList fused_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
