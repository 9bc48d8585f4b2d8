// Defines double-precision arithmetic: IEEE 754 in all roundings. A NaN result is a source's NaN, made quiet.
// SPDX-License-Identifier: Apache-2.0
#include "isa/double_nans.h"
#include "isa/op_makers.h"
#include "isa/ops/families.h"
#include "isa/ops/modifiers.h"
#include "isa/rounded_arithmetic.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr uint64_t kSign = 1ull << 63, kInfinity = 0x7ff0'0000'0000'0000, kQuiet = kQuietBit,
                   kDefaultNan = kDefaultDoubleNan, kOne = 0x3ff0'0000'0000'0000,
                   kTwo = 0x4000'0000'0000'0000, kThree = 0x4008'0000'0000'0000,
                   kThird = 0x3fd5'5555'5555'5555, kTiny = 0x3c30'0000'0000'0000;  // 2^-60
constexpr uint64_t kNan = 0x7ff8'0000'0000'0001, kSignaling = 0xfff0'0000'0000'0002;

// Both say which source's NaN a NaN result takes: first that of the named source, then that of the third
// source if there is one, then that of the other.
struct FirstNanWins {
  double operator()(double result, double a) const { return with_nan(result, a); }
  double operator()(double result, double a, double b) const { return with_nan(result, a, b); }
};
struct SecondNanWins {
  double operator()(double result, double a, double b) const { return with_nan(result, b, a); }
  double operator()(double result, double a, double b, double c) const { return with_nan(result, b, c, a); }
};

struct Add {
  using Work = Sum;
  static constexpr Text kName = "add";
  static constexpr Text kDoc = "Adds";
  static constexpr Unit kUnit = Unit::Fp64;
  using Finish = SecondNanWins;
  static constexpr Examples examples(Round round) {
    const bool is_toward_zero = round == Round::Down || round == Round::Zero;
    return {{{kOne, kTiny}, round == Round::Up ? kOne + 1 : kOne},
            {{kOne, kTiny | kSign}, is_toward_zero ? kOne - 1 : kOne},
            {{kOne, kOne | kSign}, round == Round::Down ? kSign : 0},
            {{1, 1}, 2},
            {{kInfinity, kInfinity | kSign}, kDefaultNan},
            {{kNan, kSignaling}, kSignaling | kQuiet},
            {{kNan, kOne}, kNan}};
  }
};
struct Subtract {
  using Work = Difference;
  static constexpr Text kName = "sub";
  static constexpr Text kDoc = "Subtracts";
  static constexpr Unit kUnit = Unit::Fp64;
  using Finish = SecondNanWins;
  static constexpr Examples examples(Round round) {
    const bool is_toward_zero = round == Round::Down || round == Round::Zero;
    return {{{kOne, kTiny | kSign}, round == Round::Up ? kOne + 1 : kOne},
            {{kOne, kTiny}, is_toward_zero ? kOne - 1 : kOne},
            {{kOne, kOne}, round == Round::Down ? kSign : 0},
            {{2, 1}, 1},
            {{kInfinity, kInfinity}, kDefaultNan},
            {{kOne, kSignaling}, kSignaling | kQuiet}};
  }
};
struct Multiply {
  using Work = Product;
  static constexpr Text kName = "mul";
  static constexpr Text kDoc = "Multiplies";
  static constexpr Unit kUnit = Unit::Fp64;
  using Finish = SecondNanWins;
  static constexpr Examples examples(Round round) {
    return {{{kOne + 1, kOne + 1}, round == Round::Up ? kOne + 3 : kOne + 2},
            {{kSign, kTwo}, kSign},
            {{kSign, kInfinity}, kDefaultNan},
            {{kNan, kSignaling}, kSignaling | kQuiet}};
  }
};
struct MultiplyAdd {
  using Work = ProductSum;
  static constexpr Text kDoc = "Multiplies and adds exactly";
  static constexpr Unit kUnit = Unit::Fp64;
  using Finish = SecondNanWins;
  static constexpr Examples examples(Round round) {
    return {{{kOne + 1, kOne + 1, (kOne + 2) | kSign}, 0x3970'0000'0000'0000},
            {{kOne, kOne, kTiny}, round == Round::Up ? kOne + 1 : kOne},
            {{kInfinity, 0, 0}, kDefaultNan},
            {{kInfinity, 0, kNan}, kNan},
            {{kNan, kSignaling, kNan}, kSignaling | kQuiet},
            {{kNan, 0, kSignaling}, kSignaling | kQuiet}};
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
  static constexpr Unit kUnit = Unit::Fp64Div;
  using Finish = FirstNanWins;
  static constexpr Examples examples(Round round) {
    return {{{kOne, kThree}, round == Round::Up ? kThird + 1 : kThird},
            {{kOne, kSign}, kInfinity | kSign},
            {{0, 0}, kDefaultNan},
            {{kNan, kSignaling}, kNan}};
  }
};
struct Reciprocal {
  using Work = Inverse;
  static constexpr Text kName = "rcp";
  static constexpr Text kDoc = "Computes the reciprocal";
  static constexpr Unit kUnit = Unit::Fp64Div;
  using Finish = FirstNanWins;
  static constexpr Examples examples(Round round) {
    return {{{kThree}, round == Round::Up ? kThird + 1 : kThird},
            {{kSign}, kInfinity | kSign},
            {{kSignaling}, kSignaling | kQuiet}};
  }
};
struct SquareRoot {
  using Work = Root;
  static constexpr Text kName = "sqrt";
  static constexpr Text kDoc = "Computes the square root";
  static constexpr Unit kUnit = Unit::Fp64Div;
  using Finish = FirstNanWins;
  static constexpr Examples examples(Round round) {
    const bool is_up = round == Round::Nearest || round == Round::Up;
    return {{{0x4010'0000'0000'0000}, kTwo},
            {{kTwo}, is_up ? 0x3ff6'a09e'667f'3bcdu : 0x3ff6'a09e'667f'3bccu},
            {{kSign}, kSign},
            {{kOne | kSign}, kDefaultNan}};
  }
};

// Makes the rows {.rn,.rz,.rm,.rp}.
template <class Op, class... A>
constexpr auto rounded = generated<4>([](auto i) {
  return rounded_op<kRounds[i], typename Op::Work, A...>(
      joined<Op::kName, round_name<kRounds[i]>, ".f64">, Op::kUnit,
      joined<Op::kDoc, round_words<kRounds[i]>, ".">, typename Op::Finish{}, Op::examples(kRounds[i]));
});

// Returns signed integers that have the order of the doubles, with -0 before +0.
inline int64_t ordered(double x) {
  const int64_t bits = int64_t(double_bits(x));
  return bits ^ ((bits >> 63) & int64_t(~kSign));
}
template <bool kMax>
inline double extreme(double a, double b) {
  const bool is_first = kMax ? ordered(a) > ordered(b) : ordered(a) < ordered(b);
  const double number = is_first ? a : b;
  const double with_a = is_nan(a) ? b : number;
  const double with_b = is_nan(a) ? quiet(b) : a;
  return is_nan(b) ? with_b : with_a;
}

constexpr std::array kPlainRows = {
    binary<double>("min.f64", Unit::Fp64,
                   "Returns the smaller source. A NaN loses against a number, and -0 counts as less than +0.",
                   [](double a, double b) { return extreme<false>(a, b); },
                   {{{kNan, kOne}, kOne},
                    {{kOne, kSignaling}, kOne},
                    {{kNan, kSignaling}, kSignaling | kQuiet},
                    {{0, kSign}, kSign},
                    {{kSign, 0}, kSign},
                    {{kOne, kTwo | kSign}, kTwo | kSign}}),
    binary<double>("max.f64", Unit::Fp64,
                   "Returns the larger source. A NaN loses against a number, and +0 counts as more than -0.",
                   [](double a, double b) { return extreme<true>(a, b); },
                   {{{kNan, kOne}, kOne},
                    {{kOne, kSignaling}, kOne},
                    {{kNan, kSignaling}, kSignaling | kQuiet},
                    {{0, kSign}, 0},
                    {{kSign, 0}, 0},
                    {{kOne, kTwo | kSign}, kOne}}),
    unary<uint64_t>(
        "neg.f64", Unit::Fp64, "Negates. A NaN keeps its sign and becomes quiet.",
        [](uint64_t a) { return (a & ~kSign) > kInfinity ? a | kQuiet : a ^ kSign; },
        {{{kOne}, kOne | kSign}, {{0}, kSign}, {{kSignaling}, kSignaling | kQuiet}, {{kNan}, kNan}}),
    unary<uint64_t>(
        "abs.f64", Unit::Fp64, "Returns the magnitude. A NaN keeps its sign and becomes quiet.",
        [](uint64_t a) { return (a & ~kSign) > kInfinity ? a | kQuiet : a & ~kSign; },
        {{{kOne | kSign}, kOne}, {{kSign}, 0}, {{kSignaling}, kSignaling | kQuiet}, {{kNan}, kNan}}),
    binary<uint64_t>("copysign.f64", Unit::Int,
                     "Returns the second source with the sign of the first (the order of PTX).",
                     [](uint64_t a, uint64_t b) { return (a & kSign) | (b & ~kSign); },
                     {{{kOne, kSign}, 0}, {{kSign, kOne}, kOne | kSign}}),
    unary<uint64_t>("testp.finite.f64", Unit::Fp64, "Gives true for numbers that are not infinite.",
                    [](uint64_t a) { return (a & ~kSign) < kInfinity; },
                    {{{kInfinity - 1}, 1}, {{kInfinity}, 0}, {{kNan}, 0}, {{1}, 1}}),
    unary<uint64_t>("testp.infinite.f64", Unit::Fp64, "Gives true for the infinities.",
                    [](uint64_t a) { return (a & ~kSign) == kInfinity; },
                    {{{kInfinity - 1}, 0}, {{kInfinity | kSign}, 1}, {{kNan}, 0}}),
    unary<uint64_t>("testp.number.f64", Unit::Fp64, "Gives true for everything except NaN.",
                    [](uint64_t a) { return (a & ~kSign) <= kInfinity; },
                    {{{kInfinity}, 1}, {{kSignaling}, 0}, {{kNan}, 0}, {{1}, 1}}),
    unary<uint64_t>("testp.notanumber.f64", Unit::Fp64, "Gives true for NaN.",
                    [](uint64_t a) { return (a & ~kSign) > kInfinity; },
                    {{{kInfinity}, 0}, {{kSignaling}, 1}, {{kNan}, 1}}),
    unary<uint64_t>("testp.normal.f64", Unit::Fp64,
                    "Gives true for finite numbers that are not subnormal, with zero.",
                    [](uint64_t a) {
                      const uint64_t exponent = a & kInfinity;
                      return exponent != kInfinity && (exponent != 0 || (a & ~kSign) == 0);
                    },
                    {{{0}, 1}, {{1}, 0}, {{kOne}, 1}, {{kInfinity}, 0}, {{kNan}, 0}}),
    unary<uint64_t>("testp.subnormal.f64", Unit::Fp64,
                    "Gives true for numbers nearer to zero than 2^-1022, except zero.",
                    [](uint64_t a) { return (a & kInfinity) == 0 && (a & ~kSign) != 0; },
                    {{{0}, 0}, {{1}, 1}, {{kSign | 1}, 1}, {{0x0010'0000'0000'0000}, 0}}),
};

constexpr auto kRows = joined_rows(rounded<Add, double, double>, rounded<Subtract, double, double>,
                                   rounded<Multiply, double, double>, rounded<Fma, double, double, double>,
                                   rounded<Mad, double, double, double>, rounded<Divide, double, double>,
                                   rounded<Reciprocal, double>, rounded<SquareRoot, double>, kPlainRows);

}  // namespace

RowList double_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
