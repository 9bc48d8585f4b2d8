// Defines conversions that pack several results into a register, and the formats of tensor cores: pairs,
// tf32, bytes.
// SPDX-License-Identifier: Apache-2.0
#include "isa/half_rows.h"
#include "isa/ops/conversion_types.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Applies .relu: negative numbers and -0 become +0, and a NaN stays.
template <bool kOn>
inline float relu(float x) {
  return kOn && x <= 0.0f ? 0.0f : x;
}

// Makes one half of a pair from a row of floats.
template <class N, Round kRound, bool kRelu>
[[gnu::always_inline]] inline void narrow_row(const Source<float>& source, uint32_t* out) {
  alignas(64) float x[kLanes];
  all_lanes([&](int i) { x[i] = relu<kRelu>(source.at(i)); });
  if constexpr (std::is_same_v<N, TypeF16>)
    narrow_to_halves<kRound>(x, out);
  else
    all_lanes([&](int i) { out[i] = rounded_bfloat<kRound>(x[i]).bits; });
}
template <class N, Round kRound, bool kRelu>
[[gnu::flatten]] void run_pair(Warp& warp, const Inst& inst, const OpRow& row) {
  if (ran_some_lanes<uint32_t>(warp, inst, row, &run_pair<N, kRound, kRelu>)) return;
  const Slot* const slot = &inst.operand.front();
  alignas(64) uint32_t high[kLanes], low[kLanes];
  narrow_row<N, kRound, kRelu>(Source<float>(warp, slot[1]), high);
  narrow_row<N, kRound, kRelu>(Source<float>(warp, slot[2]), low);
  write_all_lanes<uint32_t>(warp, slot[0], [&](int i) { return high[i] << 16 | low[i]; });
}
// Converts two floats to a pair. The first source becomes the upper half.
template <class N, Round kRound, bool kRelu>
constexpr OpRow pair_row() {
  OpRow row;
  row.name = joined<"cvt", round_name<kRound>, when<kRelu, ".relu">, N::kName, "x2.f32">;
  row.operands = {Dst32, Src32, Src32};
  row.run = &run_pair<N, kRound, kRelu>;
  row.doc = kRelu ? "Narrows two floats, the first to the upper half. Negative numbers become 0."
                  : "Narrows two floats, the first to the upper half.";
  row.examples = {{{TypeF32::kTwoAndHalf, TypeF32::kOne}, N::kTwoAndHalf << 16 | N::kOne},
                  {{TypeF32::kOne, TypeF32::kMinusOne}, N::kOne << 16 | (kRelu ? 0 : N::kMinusOne)}};
  return row;
}
template <class N>
constexpr auto pair_rows() {
  return joined_rows(pair_row<N, Round::Nearest, false>(), pair_row<N, Round::Nearest, true>(),
                     pair_row<N, Round::Zero, false>(), pair_row<N, Round::Zero, true>());
}

// tf32 is a float whose mantissa has 10 bits. Recordings show that a NaN loses the other bits, too.
constexpr uint32_t kTf32Mask = 0xffff'e000u;
inline uint32_t tf32_away(float x) {
  const uint32_t bits = float_bits(x);
  return ((bits & 0x7f80'0000u) == 0x7f80'0000u ? bits : bits + 0x1000u) & kTf32Mask;
}

// Describes floats of a byte: a sign, kExponentBits bits of exponent, and the rest mantissa. kLargest is the
// largest number, and kNan is the result for a NaN.
struct E4m3 {
  static constexpr auto kName = Text(".e4m3x2");
  static constexpr int kMantissaBits = 3, kBias = 7;
  static constexpr uint32_t kLargest = 0x7e, kNan = 0x7f;
  static constexpr float kLargestValue = 448.0f;
  static constexpr uint64_t kOne = 0x38, kMinusTwo = 0xc0;
};
struct E5m2 {
  static constexpr auto kName = Text(".e5m2x2");
  static constexpr int kMantissaBits = 2, kBias = 15;
  static constexpr uint32_t kLargest = 0x7b, kNan = 0x7f;
  static constexpr float kLargestValue = 57344.0f;
  static constexpr uint64_t kOne = 0x3c, kMinusTwo = 0xc0;
};
// Rounds to nearest even. A value that is too large becomes the largest number.
template <class F>
inline uint32_t byte_float(float x) {
  constexpr int kDrop = 23 - F::kMantissaBits;
  const uint32_t bits = float_bits(x), magnitude = bits & 0x7fff'ffffu;
  const float m = float_of(magnitude), limited = m < F::kLargestValue ? m : F::kLargestValue;
  const uint32_t l = float_bits(limited);
  const uint32_t normal =
      ((l + (1u << (kDrop - 1)) - 1 + ((l >> kDrop) & 1)) >> kDrop) - ((127u - F::kBias) << F::kMantissaBits);
  // Floats from 2^e on have the spacing of the format's subnormals, so the addition rounds.
  constexpr uint32_t kShifter = uint32_t(127 + 1 - F::kBias - F::kMantissaBits + 23) << 23;
  const uint32_t subnormal = float_bits(limited + float_of(kShifter)) - kShifter;
  const uint32_t number = l < uint32_t(128 - F::kBias) << 23 ? subnormal : normal;
  return m != m ? F::kNan : number | (bits >> 24 & 0x80);
}
template <class F>
inline uint32_t half_of_byte(uint32_t byte) {
  if constexpr (std::is_same_v<F, E5m2>) {
    return (byte & 0x7f) > 0x7c ? kCanonicalNan16 : (byte & 0xff) << 8;
  } else {
    const uint32_t magnitude = byte & 0x7f;
    const float subnormal = float(int32_t(magnitude)) * 0x1p-9f;
    const float normal = float_of((magnitude << 20) + ((127u - E4m3::kBias) << 23));
    const uint32_t half = to_half(magnitude < 8 ? subnormal : normal).bits;
    return magnitude == 0x7f ? kCanonicalNan16 : half | (byte & 0x80) << 8;
  }
}
template <bool kOn>
inline uint32_t relu_half(uint32_t half) {
  return kOn && (half & 0x8000) != 0 ? 0u : half;
}
template <class F, bool kRelu>
constexpr auto byte_rows() {
  constexpr uint64_t kLow = kRelu ? 0 : F::kMinusTwo;
  return joined_rows(
      value_op<float, float>(
          joined<"cvt.rn.satfinite", when<kRelu, ".relu">, F::kName, ".f32">, Unit::Int,
          "Narrows two floats to bytes, the first to the upper one. The largest number is the limit.",
          [](float a, float b) {
            return uint16_t(byte_float<F>(relu<kRelu>(a)) << 8 | byte_float<F>(relu<kRelu>(b)));
          },
          {{{0x3f80'0000, 0xc000'0000}, F::kOne << 8 | kLow},
           {{0x7fc0'0000, 0x7f80'0000}, F::kNan << 8 | F::kLargest}}),
      unary<uint32_t>(joined<"cvt.rn.satfinite", when<kRelu, ".relu">, F::kName, ".f16x2">, Unit::Int,
                      "Narrows a pair to bytes. The largest number is the limit.",
                      [](uint32_t x) {
                        const float high = relu<kRelu>(to_float(Half{uint16_t(x >> 16)})),
                                    low = relu<kRelu>(to_float(Half{uint16_t(x)}));
                        return uint16_t(byte_float<F>(high) << 8 | byte_float<F>(low));
                      },
                      {{{0x3c00'c000}, F::kOne << 8 | kLow}, {{0x7e00'7c00}, F::kNan << 8 | F::kLargest}}),
      unary<uint16_t>(joined<"cvt.rn", when<kRelu, ".relu">, ".f16x2", F::kName>, Unit::Int,
                      "Widens two bytes to a pair exactly.",
                      [](uint16_t x) {
                        return relu_half<kRelu>(half_of_byte<F>(x >> 8)) << 16 |
                               relu_half<kRelu>(half_of_byte<F>(x));
                      },
                      {{{F::kOne << 8 | F::kMinusTwo}, kRelu ? 0x3c00'0000 : 0x3c00'c000}, {{0}, 0}}));
}

// Clamps integers to kSize bits and puts them side by side, the first source above the second.
template <int kSize, bool kSigned>
inline uint32_t clamped_bits(int32_t x) {
  constexpr int32_t kLow = kSigned ? -(1 << (kSize - 1)) : 0,
                    kHigh = kSigned ? (1 << (kSize - 1)) - 1 : (1 << kSize) - 1;
  const int32_t above = x < kLow ? kLow : x;
  return uint32_t(above > kHigh ? kHigh : above) & ((1u << kSize) - 1);
}
template <int kSize, bool kSigned, Text kName>
constexpr OpRow pack_row() {
  constexpr uint64_t kMinus = kSigned ? (1ull << kSize) - 1 : 0;
  if constexpr (kSize == 16)
    return binary<int32_t>(joined<"cvt.pack.sat", kName, ".s32">, Unit::Int,
                           "Clamps two integers to 16 bits. The first becomes the upper half.",
                           [](int32_t a, int32_t b) {
                             return clamped_bits<16, kSigned>(a) << 16 | clamped_bits<16, kSigned>(b);
                           },
                           {{{1, 2}, 0x1'0002}, {{0xffff'ffff, 0}, kMinus << 16}});
  else
    return value_op<int32_t, int32_t, uint32_t>(
        joined<"cvt.pack.sat", kName, ".s32.b32">, Unit::Int,
        "Clamps two integers to a few bits and shifts them into the third source at its low end. The second "
        "is lowest.",
        [](int32_t a, int32_t b, uint32_t c) {
          return c << 2 * kSize | clamped_bits<kSize, kSigned>(a) << kSize | clamped_bits<kSize, kSigned>(b);
        },
        {{{1, 0, 0}, 1ull << kSize}, {{0, 1, 1}, 1ull << 2 * kSize | 1}, {{0, 0xffff'ffff, 0}, kMinus}});
}

constexpr auto kRows = joined_rows(
    pair_rows<TypeF16>(), pair_rows<TypeBf16>(),
    unary<float>("cvt.rna.tf32.f32", Unit::Int, "Rounds the mantissa to 10 bits, with ties away from zero.",
                 [](float x) { return tf32_away(x); },
                 {{{0x3f80'0001}, 0x3f80'0000}, {{0x3f80'1000}, 0x3f80'2000}, {{0x7f7f'ffff}, 0x7f80'0000}}),
    byte_rows<E4m3, false>(), byte_rows<E4m3, true>(), byte_rows<E5m2, false>(), byte_rows<E5m2, true>(),
    pack_row<16, true, ".s16">(), pack_row<16, false, ".u16">(), pack_row<8, true, ".s8">(),
    pack_row<8, false, ".u8">(), pack_row<4, true, ".s4">(), pack_row<4, false, ".u4">(),
    pack_row<2, true, ".s2">(), pack_row<2, false, ".u2">());

}  // namespace

RowList convert_packed_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
