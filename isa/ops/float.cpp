// Defines single-precision arithmetic in all roundings, with flush to zero and saturation; min, max, signs,
// classes.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"
#include "isa/ops/modifiers.h"
#include "isa/rounded_arithmetic.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr uint32_t kSign = 0x8000'0000, kInfinity = 0x7f80'0000, kOne = 0x3f80'0000, kTwo = 0x4000'0000,
                   kHalf = 0x3f00'0000, kNan = kCanonicalNan;

// Returns the source; with .ftz a subnormal becomes a zero of its sign.
template <bool kFtz>
inline float taken(float x) {
  const bool is_flushed = kFtz && (float_bits(x) & kInfinity) == 0;
  return is_flushed ? float_of(float_bits(x) & kSign) : x;
}
// Clamps to [0, 1]. NaN and -0 become +0.
inline float saturated(float x) {
  const float below = x < 1.0f ? x : 1.0f;
  return x > 0.0f ? below : 0.0f;
}

// Saturates the result, or turns a NaN into the canonical one.
template <bool kSat>
struct Finish {
  template <class... A>
  float operator()(float result, A...) const {
    if constexpr (kSat)
      return saturated(result);
    else
      return canonical(result);
  }
};

struct Add {
  using Work = Sum;
  static constexpr Text kName = "add";
  static constexpr Text kDoc = "Adds";
  static constexpr Unit kUnit = Unit::Fp32;
  static constexpr Examples examples(Mode m) {
    const bool is_down = m.round == Round::Down, is_toward_zero = is_down || m.round == Round::Zero;
    return {{{kHalf, 0x3080'0000}, m.round == Round::Up ? 0x3f00'0001u : kHalf},
            {{kHalf, 0xb080'0000}, is_toward_zero ? 0x3eff'ffffu : kHalf},
            {{kOne, kOne | kSign}, is_down && !m.sat ? kSign : 0},
            {{1, 1}, m.ftz ? 0u : 2u},
            {{kOne, kOne}, m.sat ? kOne : kTwo},
            {{kInfinity, kInfinity | kSign}, m.sat ? 0 : kNan},
            {{0x7fc0'0000, 1}, m.sat ? 0 : kNan}};
  }
};
struct Subtract {
  using Work = Difference;
  static constexpr Text kName = "sub";
  static constexpr Text kDoc = "Subtracts";
  static constexpr Unit kUnit = Unit::Fp32;
  static constexpr Examples examples(Mode m) {
    const bool is_down = m.round == Round::Down, is_toward_zero = is_down || m.round == Round::Zero;
    return {{{kHalf, 0xb080'0000}, m.round == Round::Up ? 0x3f00'0001u : kHalf},
            {{kHalf, 0x3080'0000}, is_toward_zero ? 0x3eff'ffffu : kHalf},
            {{kOne, kOne}, is_down && !m.sat ? kSign : 0},
            {{2, 1},
             !m.ftz              ? 1u
             : is_down && !m.sat ? kSign
                                 : 0},
            {{kOne, kOne | kSign}, m.sat ? kOne : kTwo},
            {{kInfinity, kInfinity}, m.sat ? 0 : kNan}};
  }
};
struct Multiply {
  using Work = Product;
  static constexpr Text kName = "mul";
  static constexpr Text kDoc = "Multiplies";
  static constexpr Unit kUnit = Unit::Fp32;
  static constexpr Examples examples(Mode m) {
    return {{{0x3f00'0001, 0x3f00'0001}, m.round == Round::Up ? 0x3e80'0003u : 0x3e80'0002u},
            {{0x0080'0000, kHalf}, m.ftz ? 0u : 0x0040'0000u},
            {{kTwo, kOne}, m.sat ? kOne : kTwo},
            {{kSign, kSign}, 0},
            {{kOne | kSign, kTwo}, m.sat ? 0 : kTwo | kSign},
            {{0, kInfinity}, m.sat ? 0 : kNan}};
  }
};
struct MultiplyAdd {
  using Work = ProductSum;
  static constexpr Text kDoc = "Multiplies and adds exactly";
  static constexpr Unit kUnit = Unit::Fp32;
  static constexpr Examples examples(Mode m) {
    const bool is_down = m.round == Round::Down, is_toward_zero = is_down || m.round == Round::Zero;
    return {{{0x3f80'0001, 0x3f80'0001, 0xbf80'0002}, 0x2880'0000},
            {{kHalf, kHalf, 0x3080'0000}, m.round == Round::Up ? 0x3e80'0001u : 0x3e80'0000u},
            {{kHalf, kHalf, 0xb080'0000}, is_toward_zero ? 0x3e7f'ffffu : 0x3e80'0000u},
            {{1, kOne, 1}, m.ftz ? 0u : 2u},
            {{kOne, kOne, kOne}, m.sat ? kOne : kTwo},
            {{kInfinity, 0, 0}, m.sat ? 0 : kNan},
            {{kInfinity, kOne, kInfinity | kSign}, m.sat ? 0 : kNan}};
  }
};
struct Fma : MultiplyAdd {
  static constexpr Text kName = "fma";
};
struct Mad : MultiplyAdd {  // PTX's other name of fma
  static constexpr Text kName = "mad";
};
struct Divide {
  using Work = Quotient;
  static constexpr Text kName = "div";
  static constexpr Text kDoc = "Divides";
  static constexpr Unit kUnit = Unit::FpDiv;
  static constexpr Examples examples(Mode m) {
    const bool is_up = m.round == Round::Nearest || m.round == Round::Up;
    return {{{kOne, 0x4040'0000}, is_up ? 0x3eaa'aaabu : 0x3eaa'aaaau},
            {{kOne, kSign}, kInfinity | kSign},
            {{0, 0}, kNan},
            {{6, kTwo}, m.ftz ? 0u : 3u}};
  }
};
struct Reciprocal {
  using Work = Inverse;
  static constexpr Text kName = "rcp";
  static constexpr Text kDoc = "Computes the reciprocal";
  static constexpr Unit kUnit = Unit::FpDiv;
  static constexpr Examples examples(Mode m) {
    const bool is_up = m.round == Round::Nearest || m.round == Round::Up;
    return {{{0x4040'0000}, is_up ? 0x3eaa'aaabu : 0x3eaa'aaaau},
            {{kSign}, kInfinity | kSign},
            {{kInfinity}, 0},
            {{0x7f00'0000}, m.ftz ? 0u : 0x0040'0000u}};
  }
};
struct SquareRoot {
  using Work = Root;
  static constexpr Text kName = "sqrt";
  static constexpr Text kDoc = "Computes the square root";
  static constexpr Unit kUnit = Unit::FpDiv;
  static constexpr Examples examples(Mode m) {
    return {{{0x4080'0000}, kTwo},
            {{kTwo}, m.round == Round::Up ? 0x3fb5'04f4u : 0x3fb5'04f3u},
            {{kSign}, kSign},
            {{kOne | kSign}, kNan},
            {{4},
             m.ftz                  ? 0u
             : m.round == Round::Up ? 0x1ab5'04f4u
                                    : 0x1ab5'04f3u}};
  }
};

template <class Op, Round kRound, bool kFtz, bool kSat, class... A>
constexpr OpRow arithmetic_row() {
  return flushed_op<kRound, kFtz, typename Op::Work, A...>(
      joined<Op::kName, round_name<kRound>, when<kFtz, ".ftz">, when<kSat, ".sat">, ".f32">, Op::kUnit,
      joined<Op::kDoc, round_words<kRound>, when<kFtz, kFtzWords>, when<kSat, kSatWords>, ".">,
      Finish<kSat>{}, Op::examples({.round = kRound, .ftz = kFtz, .sat = kSat}));
}
// Makes the rows {.rn,.rz,.rm,.rp}{.ftz}, and {.sat} where PTX has it.
template <class Op, class... A>
constexpr auto saturable = generated<16>([](auto i) {
  return arithmetic_row<Op, kRounds[i / 4], i / 2 % 2, i % 2, A...>();
});
template <class Op, class... A>
constexpr auto unsaturable = generated<8>([](auto i) {
  return arithmetic_row<Op, kRounds[i / 2], i % 2, false, A...>();
});

// Returns signed integers that have the order of the floats, with -0 before +0.
inline int32_t ordered(float x) {
  const int32_t bits = int32_t(float_bits(x));
  return bits ^ ((bits >> 31) & 0x7fff'ffff);
}

// Defines min and max. Without .NaN a number wins against a NaN. .xorsign.abs compares magnitudes, and the
// result's sign is the product of the sources' signs, also of NaNs.
template <bool kMax, bool kFtz, bool kNanWins, bool kXorsign>
struct Extreme {
  float operator()(float x, float y) const {
    const uint32_t keep = kXorsign ? ~kSign : ~0u;
    const float a = float_of(float_bits(taken<kFtz>(x)) & keep);
    const float b = float_of(float_bits(taken<kFtz>(y)) & keep);
    const bool is_first = kMax ? ordered(a) > ordered(b) : ordered(a) < ordered(b);
    const float number = is_first ? a : b;
    const float with_a = is_nan(a) ? (kNanWins ? a : b) : number;
    const float result = is_nan(b) ? (kNanWins ? b : a) : with_a;
    const uint32_t sign = kXorsign ? (float_bits(x) ^ float_bits(y)) & kSign : 0;
    return canonical(float_of(float_bits(result) ^ sign));
  }
};
template <bool kMax, bool kFtz, bool kNanWins, bool kXorsign>
constexpr OpRow extreme_row() {
  constexpr uint32_t kOther = kNanWins ? kNan : kOne, kSmall = kFtz ? 0 : 1;
  constexpr uint32_t kZeros = kMax && !kXorsign ? 0 : kSign;
  constexpr uint32_t kSigned = kXorsign || !kMax ? kSign | kSmall : kSmall;
  return binary<float>(
      joined<when<kMax, "max">, when<!kMax, "min">, when<kFtz, ".ftz">, when<kNanWins, ".NaN">,
             when<kXorsign, ".xorsign.abs">, ".f32">,
      Unit::Fp32,
      joined<when<kMax, "Returns the larger source">, when<!kMax, "Returns the smaller source">,
             when<kXorsign, " magnitude, with the product of the signs">, ". -0 counts as less than +0, ",
             when<kNanWins, "and a NaN wins">, when<!kNanWins, "and a NaN loses against a number">,
             when<kFtz, kFtzWords>, ".">,
      Extreme<kMax, kFtz, kNanWins, kXorsign>{},
      {{{0x7fc0'0000, kOne}, kOther},
       {{kOne, 0x7f80'0001}, kOther},
       {{0x7fc0'0000, 0xffc0'0000}, kNan},
       {{0, kSign}, kZeros},
       {{kSign, 0}, kZeros},
       {{1, kSign | 1}, kSigned},
       {{kOne, kTwo}, kMax ? kTwo : kOne}});
}
template <bool kMax>
constexpr auto extremes = generated<8>([](auto i) { return extreme_row<kMax, i / 4, i / 2 % 2, i % 2>(); });

template <bool kFtz>
constexpr std::array<OpRow, 2> sign_rows = {
    unary<float>(
        joined<"neg", when<kFtz, ".ftz">, ".f32">, Unit::Fp32, joined<"Negates", when<kFtz, kFtzWords>, ".">,
        [](float a) { return canonical(-taken<kFtz>(a)); },
        {{{kOne}, kOne | kSign}, {{0}, kSign}, {{0xffc0'0000}, kNan}, {{1}, kSign | (kFtz ? 0 : 1)}}),
    unary<float>(joined<"abs", when<kFtz, ".ftz">, ".f32">, Unit::Fp32,
                 joined<"Returns the magnitude", when<kFtz, kFtzWords>, ".">,
                 [](float a) { return canonical(float_of(float_bits(taken<kFtz>(a)) & ~kSign)); },
                 {{{kOne | kSign}, kOne}, {{kSign}, 0}, {{0xffc0'0000}, kNan}, {{kSign | 1}, kFtz ? 0 : 1}})};

constexpr std::array kClassRows = {
    binary<uint32_t>("copysign.f32", Unit::Int,
                     "Returns the second source with the sign of the first (the order of PTX).",
                     [](uint32_t a, uint32_t b) { return (a & kSign) | (b & ~kSign); },
                     {{{kOne, kSign}, 0}, {{kSign, kOne}, kOne | kSign}}),
    unary<uint32_t>("testp.finite.f32", Unit::Fp32, "Gives true for numbers that are not infinite.",
                    [](uint32_t a) { return (a & ~kSign) < kInfinity; },
                    {{{0x7f7f'ffff}, 1}, {{kInfinity}, 0}, {{0x7fc0'0000}, 0}, {{1}, 1}}),
    unary<uint32_t>("testp.infinite.f32", Unit::Fp32, "Gives true for the infinities.",
                    [](uint32_t a) { return (a & ~kSign) == kInfinity; },
                    {{{0x7f7f'ffff}, 0}, {{kInfinity | kSign}, 1}, {{0x7fc0'0000}, 0}}),
    unary<uint32_t>("testp.number.f32", Unit::Fp32, "Gives true for everything except NaN.",
                    [](uint32_t a) { return (a & ~kSign) <= kInfinity; },
                    {{{kInfinity}, 1}, {{0x7f80'0001}, 0}, {{0xffc0'0000}, 0}, {{1}, 1}}),
    unary<uint32_t>("testp.notanumber.f32", Unit::Fp32, "Gives true for NaN.",
                    [](uint32_t a) { return (a & ~kSign) > kInfinity; },
                    {{{kInfinity}, 0}, {{0x7f80'0001}, 1}, {{0xffc0'0000}, 1}}),
    unary<uint32_t>("testp.normal.f32", Unit::Fp32,
                    "Gives true for finite numbers that are not subnormal, with zero.",
                    [](uint32_t a) {
                      const uint32_t exponent = a & kInfinity;
                      return exponent != kInfinity && (exponent != 0 || (a & ~kSign) == 0);
                    },
                    {{{0}, 1}, {{1}, 0}, {{kOne}, 1}, {{kInfinity}, 0}, {{0x7fc0'0000}, 0}}),
    unary<uint32_t>("testp.subnormal.f32", Unit::Fp32,
                    "Gives true for numbers nearer to zero than 2^-126, except zero.",
                    [](uint32_t a) { return (a & kInfinity) == 0 && (a & ~kSign) != 0; },
                    {{{0}, 0}, {{1}, 1}, {{kSign | 0x007f'ffff}, 1}, {{0x0080'0000}, 0}}),
};

constexpr auto kRows = joined_rows(
    saturable<Add, float, float>, saturable<Subtract, float, float>, saturable<Multiply, float, float>,
    saturable<Fma, float, float, float>, saturable<Mad, float, float, float>,
    unsaturable<Divide, float, float>, unsaturable<Reciprocal, float>, unsaturable<SquareRoot, float>,
    extremes<false>, extremes<true>, sign_rows<false>, sign_rows<true>, kClassRows);

}  // namespace

RowList float_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
