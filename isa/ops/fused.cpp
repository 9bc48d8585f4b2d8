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
      ternary<T>(joined<"min3", N::kName>, Unit::Int, "Returns the smallest of three numbers.",
                 [](T a, T b, T c) {
                   const T least = a < b ? a : b;
                   return least < c ? least : c;
                 },
                 {{{5, 3, 4}, 3}, {{kOnes, 2, 7}, kSigned ? kOnes : 2}}),
      ternary<T>(joined<"max3", N::kName>, Unit::Int, "Returns the largest of three numbers.",
                 [](T a, T b, T c) {
                   const T most = a > b ? a : b;
                   return most > c ? most : c;
                 },
                 {{{5, 3, 4}, 5}, {{kOnes, 2, 7}, kSigned ? 7 : kOnes}}),
      value_op<T, uint32_t, T>(
          joined<"shradd", N::kName>, Unit::Int,
          "Shifts the first source right by the second, as shr does, and adds the third.",
          [](T a, uint32_t n, T b) { return T(Unsigned<T>(shifted_right(a, n)) + Unsigned<T>(b)); },
          {{{13, 2, 4}, 7}, {{kOnes, 31, 1}, kSigned ? 0 : 2}}));
}

// Converts a part of a word that does not begin at its lowest bit.
template <Text kName, uint32_t kAt, uint32_t kMask>
constexpr OpRow part_row(uint64_t example, uint64_t result) {
  return unary<uint32_t>(joined<"cvt.rn.f32", kName>, Unit::Int,
                         "Converts a part of a word, counted from the low end, without a sign.",
                         [](uint32_t a) { return float(a >> kAt & kMask); }, {{{example}, result}, {{0}, 0}});
}

constexpr std::string_view kHalfDoc =
    "Does the same as the op without .half, where it is known at compile time that one half of the result is "
    "a half of a source, or 0.";
constexpr uint64_t kLowHalf = 0xffff'ffff;

constexpr auto kRows = joined_rows(
    part_row<".u8.b1", 8, 0xff>(0x4321'0240, 0x4000'0000),
    part_row<".u8.b2", 16, 0xff>(0x4302'4040, 0x4000'0000),
    part_row<".u8.b3", 24, 0xff>(0x0265'4040, 0x4000'0000),
    part_row<".u16.h1", 16, 0xffff>(0x0002'4040, 0x4000'0000),
    binary<uint64_t>("and.half.b64", Unit::Int, kHalfDoc, [](uint64_t a, uint64_t b) { return a & b; },
                     {{{kLowHalf << 8, 0xff00}, 0xff00}, {{7, 2}, 2}}),
    binary<uint64_t>("or.half.b64", Unit::Int, kHalfDoc, [](uint64_t a, uint64_t b) { return a | b; },
                     {{{uint64_t{1} << 40, 3}, (uint64_t{1} << 40) + 3}, {{1, 2}, 3}}),
    binary<uint64_t>("xor.half.b64", Unit::Int, kHalfDoc, [](uint64_t a, uint64_t b) { return a ^ b; },
                     {{{(uint64_t{1} << 40) + 1, 3}, (uint64_t{1} << 40) + 2}, {{1, 1}, 0}}),
    value_op<uint64_t, uint32_t>("shl.half.b64", Unit::Int, kHalfDoc,
                                 [](uint64_t a, uint32_t n) { return n < 64 ? a << n : 0; },
                                 {{{3, 40}, uint64_t{3} << 40}, {{3, 64}, 0}}),
    value_op<uint64_t, uint32_t>("shr.half.u64", Unit::Int, kHalfDoc,
                                 [](uint64_t a, uint32_t n) { return n < 64 ? a >> n : 0; },
                                 {{{uint64_t{3} << 40, 40}, 3}, {{3, 64}, 0}}),
    value_op<uint64_t, uint32_t>("shr.low.u64", Unit::Int,
                                 "Shifts right as shr does, and returns the low word of the result.",
                                 [](uint64_t a, uint32_t n) { return uint32_t(n < 64 ? a >> n : 0); },
                                 {{{uint64_t{3} << 40, 40}, 3}, {{uint64_t{3} << 40, 8}, 0}}),
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
    binary<float>("nmul.rn.f32", Unit::Fp32,
                  "Multiplies the negative of the first source by the second, and rounds to nearest even.",
                  [](float a, float b) { return canonical(-a * b); },
                  {{{kOne, kTwo}, kTwo | kSign}, {{kOne | kSign, kTwo}, kTwo}}),
    value_op<int32_t, uint64_t>(
        "add.wide.s32", Unit::Int, "Adds a word, extended with its sign, to a number of 64 bits.",
        [](int32_t a, uint64_t b) { return uint64_t(int64_t{a}) + b; }, {{{0xffff'ffff, 5}, 4}, {{2, 3}, 5}}),
    value_op<uint32_t, uint64_t>("add.wide.u32", Unit::Int, "Adds a word to a number of 64 bits.",
                                 [](uint32_t a, uint64_t b) { return uint64_t{a} + b; },
                                 {{{0xffff'ffff, 5}, 0x1'0000'0004}, {{2, 3}, 5}}),
    value_op<uint64_t, uint32_t>("rotl.b64", Unit::Int, "Rotates left by a count modulo 64.",
                                 [](uint64_t a, uint32_t n) { return a << (n & 63) | a >> (-n & 63); },
                                 {{{(uint64_t{1} << 63) + 1, 1}, 3}, {{5, 64}, 5}}),
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
