// Defines floats of 16 bits, alone and in pairs: f16 and bf16 arithmetic, rounded once; min, max, signs.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <type_traits>

#include "isa/half_rows.h"
#include "isa/ops/families.h"
#include "isa/ops/modifiers.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr uint32_t kSign = 0x8000, kNan = kCanonicalNan16;  // as 16 bits

inline uint32_t all_ones_if_negative(uint32_t x) {
  return uint32_t(int32_t(x) >> 31);
}

// Holds one float of each lane.
struct alignas(64) Floats {
  float at[kLanes];
};

// Describes a format for the rows below.
struct F16 {
  static constexpr Text kName = ".f16";
  static constexpr bool kHasFtz = true;
  static constexpr uint32_t kInfinity = 0x7c00, kOne = 0x3c00, kTwo = 0x4000, kHalf = 0x3800;
  static constexpr uint32_t kSmallest = 0x0400;  // normal
  static constexpr uint32_t kHalfUlp = 0x1000;   // of 1
  static constexpr uint32_t kTied = 0x3be0, kAboveTie = 0x3bc1;
  template <bool kUpper>
  [[gnu::always_inline]] static void widen(const uint32_t* words, float* out) {
    widen_halves<kUpper>(words, out);
  }
  [[gnu::always_inline]] static void narrow(const float* x, uint32_t* out) {
    narrow_to_halves<Round::Nearest>(x, out);
  }

  // Computes fma to odd: as if rounded toward zero, with the last bit set if that was not exact. Rounding it
  // again to fewer bits is then correct (Boldo and Melquiond 2008, "Emulation of FMA and correctly rounded
  // sums"). The product is exact in single precision, and Knuth's two-sum gives the error of the sum.
  [[gnu::always_inline]] static float fma_to_odd(float a, float b, float c) {
    const float product = a * b;
    const float sum = product + c;
    const float part = sum - product;
    const float error = (product - (sum - part)) + (c - part);
    return to_odd(sum, error);
  }

  // Steps once toward zero if the error has the other sign, then sets the last bit. An odd sum stays as it
  // is.
  [[gnu::always_inline]] static float to_odd(float sum, float error) {
    const uint32_t bits = float_bits(sum);
    const uint32_t odd = (bits + all_ones_if_negative(float_bits(error) ^ bits)) | 1;
    // False for a NaN error, because the sum is then not finite.
    const bool is_off = __builtin_fabsf(error) > 0;
    return float_of(is_off ? odd : bits);
  }
};
struct Bf16 {
  static constexpr Text kName = ".bf16";
  static constexpr bool kHasFtz = false;  // .ftz and .sat
  static constexpr uint32_t kInfinity = 0x7f80, kOne = 0x3f80, kTwo = 0x4000, kHalf = 0x3f00;
  static constexpr uint32_t kSmallest = 0x0080;  // normal
  static constexpr uint32_t kHalfUlp = 0x3b80;   // of 1
  static constexpr uint32_t kTied = 0x3f28, kAboveTie = 0x3edd;
  template <bool kUpper>
  [[gnu::always_inline]] static void widen(const uint32_t* words, float* out) {
    all_lanes([&](int i) { out[i] = float_of(kUpper ? words[i] & 0xffff'0000u : words[i] << 16); });
  }
  [[gnu::always_inline]] static void narrow(const float* x, uint32_t* out) {
    all_lanes([&](int i) { out[i] = bfloat_bits(x[i]); });
  }

  // Does the same as F16::fma_to_odd(), but the product may leave the range of single precision. So the
  // larger of product and addend is subtracted from the sum first (Dekker's fast two-sum), and the product
  // within an fma, where it has any range.
  [[gnu::always_inline]] static float fma_to_odd(float a, float b, float c) {
    const float sum = __builtin_fmaf(a, b, c);
    const float rest = __builtin_fmaf(a, b, -sum) + c;
    const float other = __builtin_fmaf(a, b, c - sum);
    const bool is_product_larger = __builtin_fabsf(a * b) >= __builtin_fabsf(c);
    return F16::to_odd(sum, is_product_larger ? rest : other);
  }
};

// For sums, differences and products, single precision has so many bits that rounding twice gives the same
// result as rounding once (Figueroa 1995, "When is double rounding innocuous?").
struct Add {
  static constexpr Text kName = "add";
  static constexpr Text kDoc = "Adds";
  static constexpr size_t kSources = 2;
  template <class Format>
  [[gnu::always_inline]] static void run(const Floats* in, float* out) {
    all_lanes([&](int i) { out[i] = in[0].at[i] + in[1].at[i]; });
  }
  template <class Format>
  static constexpr Examples examples(Mode m) {
    return {{{Format::kOne, Format::kOne}, m.sat ? Format::kOne : Format::kTwo},
            {{Format::kOne, Format::kHalfUlp}, Format::kOne},
            {{Format::kOne | kSign, 0}, m.sat ? 0 : Format::kOne | kSign},
            {{1, 1}, m.ftz ? 0u : 2u},
            {{Format::kInfinity, Format::kInfinity | kSign}, m.sat ? 0 : kNan}};
  }
};
struct Subtract {
  static constexpr Text kName = "sub";
  static constexpr Text kDoc = "Subtracts";
  static constexpr size_t kSources = 2;
  template <class Format>
  [[gnu::always_inline]] static void run(const Floats* in, float* out) {
    all_lanes([&](int i) { out[i] = in[0].at[i] - in[1].at[i]; });
  }
  template <class Format>
  static constexpr Examples examples(Mode m) {
    return {{{Format::kOne, Format::kOne | kSign}, m.sat ? Format::kOne : Format::kTwo},
            {{Format::kOne, Format::kHalfUlp | kSign}, Format::kOne},
            {{0, Format::kOne}, m.sat ? 0 : Format::kOne | kSign},
            {{2, 1}, m.ftz ? 0u : 1u},
            {{Format::kInfinity, Format::kInfinity}, m.sat ? 0 : kNan}};
  }
};
struct Multiply {
  static constexpr Text kName = "mul";
  static constexpr Text kDoc = "Multiplies";
  static constexpr size_t kSources = 2;
  template <class Format>
  [[gnu::always_inline]] static void run(const Floats* in, float* out) {
    all_lanes([&](int i) { out[i] = in[0].at[i] * in[1].at[i]; });
  }
  template <class Format>
  static constexpr Examples examples(Mode m) {
    return {{{Format::kTwo, Format::kOne}, m.sat ? Format::kOne : Format::kTwo},
            {{Format::kOne + 1, Format::kOne + 1}, m.sat ? Format::kOne : Format::kOne + 2},
            {{Format::kSmallest, Format::kHalf}, m.ftz ? 0 : Format::kSmallest / 2},
            {{kSign, Format::kOne}, m.sat ? 0 : kSign},
            {{0, Format::kInfinity}, m.sat ? 0 : kNan}};
  }
};
struct Fma {
  static constexpr Text kName = "fma";
  static constexpr Text kDoc = "Multiplies and adds exactly";
  static constexpr size_t kSources = 3;
  template <class Format>
  [[gnu::always_inline]] static void run(const Floats* in, float* out) {
    fma_rows_to_odd(in[0].at, in[1].at, in[2].at, out,
                    [](float a, float b, float c) { return Format::fma_to_odd(a, b, c); });
  }
  template <class Format>
  static constexpr Examples examples(Mode m) {
    const uint32_t below = m.sat || m.relu ? 0 : Format::kOne | kSign;
    return {{{Format::kOne, Format::kOne, Format::kOne}, m.sat ? Format::kOne : Format::kTwo},
            // The product is a tie, but the addend is not zero.
            {{Format::kTied, Format::kTied, Format::kSmallest}, Format::kAboveTie},
            {{Format::kTied, Format::kTied, Format::kSmallest | kSign}, Format::kAboveTie - 1},
            {{Format::kOne | kSign, Format::kOne, 0}, below},
            {{Format::kSmallest, Format::kHalf, 0}, m.ftz ? 0 : Format::kSmallest / 2},
            {{Format::kInfinity, 0, 0}, m.sat ? 0 : kNan}};
  }
};

// Replaces a number below the one with the bits kLeast by a zero of its sign.
template <uint32_t kLeast>
[[gnu::always_inline]] inline float zero_below(float x) {
  const uint32_t bits = float_bits(x);
  return float_of((bits & 0x7fff'ffffu) < kLeast ? bits & 0x8000'0000u : bits);
}

// Handles a row: converts halves to floats, computes in single precision, and converts back. The halves of a
// pair are handled one after the other.
template <class Format, bool kPair, class Op, bool kFtz, bool kSat, bool kRelu>
struct Arithmetic {
  [[gnu::flatten]] static void run(Warp& warp, const Inst& inst, const OpRow& row) {
    if (ran_some_lanes<uint32_t>(warp, inst, row, &run)) return;
    alignas(64) uint32_t low[kLanes], high[kLanes];
    half<false>(warp, inst, low);
    if constexpr (kPair) half<true>(warp, inst, high);
    write_all_lanes<uint32_t>(warp, inst.operand.front(),
                              [&](int i) { return kPair ? low[i] | high[i] << 16 : low[i]; });
  }
  template <bool kUpper>
  [[gnu::always_inline]] static void half(const Warp& warp, const Inst& inst, uint32_t* out) {
    constexpr uint32_t kLeastNormal = 0x3880'0000;  // 2^-14, because f16 is the only format with .ftz
    // With an unbounded exponent, f16 would round smaller numbers to less than 2^-14.
    constexpr uint32_t kLeastKept = 0x387f'f000;
    Floats in[Op::kSources], result;
    for (size_t n = 0; n < Op::kSources; ++n) {
      const Source<uint32_t> source(warp, *(&inst.operand.front() + 1 + n));
      Format::template widen<kUpper>(source.low, in[n].at);
      if constexpr (kFtz) all_lanes([&](int i) { in[n].at[i] = zero_below<kLeastNormal>(in[n].at[i]); });
    }
    Op::template run<Format>(in, result.at);
    if constexpr (kSat) all_lanes([&](int i) { result.at[i] = saturated(result.at[i]); });
    if constexpr (kRelu)
      all_lanes([&](int i) { result.at[i] = result.at[i] <= 0.0f ? 0.0f : result.at[i]; });  // a NaN stays
    if constexpr (kFtz) all_lanes([&](int i) { result.at[i] = zero_below<kLeastKept>(result.at[i]); });
    Format::narrow(result.at, out);
  }
};

// Takes and returns upper halves. With .ftz a subnormal becomes a zero of its sign.
template <class Format, bool kFtz>
inline uint32_t taken(uint32_t upper) {
  const uint32_t exponent = upper & Format::kInfinity << 16;
  const uint32_t flushed = kFtz ? all_ones_if_negative(exponent - 1) : 0;  // exponent 0
  return upper & (~flushed | kSign << 16) & 0xffff'0000u;
}
template <class Format>
inline bool is_nan_upper(uint32_t upper) {
  return (upper & 0x7fff'0000u) > Format::kInfinity << 16;
}
// Returns signed integers that have the order of the floats, with -0 before +0.
inline int32_t ordered(uint32_t upper) {
  const int32_t bits = int32_t(upper);
  return bits ^ ((bits >> 31) & 0x7fff'ffff);
}

// Defines min and max. Without .NaN a number wins against a NaN. .xorsign.abs compares magnitudes, and the
// result's sign is the product of the sources' signs, also of NaNs.
template <class Format, bool kMax, bool kFtz, bool kNanWins, bool kXorsign>
struct Extreme {
  [[gnu::always_inline]] uint32_t operator()(uint32_t x, uint32_t y) const {
    const uint32_t keep = kXorsign ? 0x7fff'0000u : 0xffff'0000u;
    const uint32_t a = taken<Format, kFtz>(x) & keep, b = taken<Format, kFtz>(y) & keep;
    const bool is_first = kMax ? ordered(a) > ordered(b) : ordered(a) < ordered(b);
    const bool is_a_nan = is_nan_upper<Format>(a), is_b_nan = is_nan_upper<Format>(b);
    const uint32_t number = is_first ? a : b;
    const uint32_t with_a = is_a_nan ? (kNanWins ? a : b) : number;
    const uint32_t result = is_b_nan ? (kNanWins ? b : a) : with_a;
    const uint32_t sign = kXorsign ? (x ^ y) & kSign << 16 : 0;
    return is_nan_upper<Format>(result) ? kNan : (result ^ sign) >> 16;
  }
};

template <class Format, bool kAbs, bool kFtz>
struct Sign {
  [[gnu::always_inline]] uint32_t operator()(uint32_t x) const {
    const uint32_t bits = taken<Format, kFtz>(x);
    const uint32_t result = kAbs ? bits & 0x7fff'0000u : bits ^ kSign << 16;
    return is_nan_upper<Format>(bits) ? kNan : result >> 16;
  }
};

// Sources and results are the lower halves of registers.
template <class F>
struct Lower {
  template <class... A>
  [[gnu::always_inline]] uint32_t operator()(A... word) const {
    return F{}(word << 16 ...);
  }
};
template <class F>
struct Both {
  template <class... A>
  [[gnu::always_inline]] uint32_t operator()(A... word) const {
    return F{}(word << 16 ...) | F{}(word...) << 16;
  }
};
constexpr Examples paired(const Examples& of_one) {
  Examples out = of_one;
  for (size_t i = 0; i < out.count; ++i) {
    const Example& high = of_one.at[(i + 1) % out.count];
    for (size_t k = 0; k < high.in.size(); ++k) out.at[i].in[k] |= high.in[k] << 16;
    out.at[i].out |= high.out << 16;
  }
  return out;
}

// Makes a row of `kSources` sources of the format, or of pairs of it.
template <bool kPair, size_t kSources, class F>
constexpr OpRow row(std::string_view name, std::string_view doc, F, const Examples& examples) {
  using Lane = std::conditional_t<kPair, Both<F>, Lower<F>>;
  return [&]<size_t... I>(std::index_sequence<I...>) {
    return value_op<decltype((void(I), uint32_t{}))...>(name, Unit::Fp16, doc, Lane{},
                                                        kPair ? paired(examples) : examples);
  }
  (std::make_index_sequence<kSources>{});
}
template <class Format, bool kPair>
constexpr auto suffix = Joined<Format::kName, when<kPair, "x2">>::kAsText;
template <bool kPair>
constexpr auto pair_words = when<kPair, " in each half of a register">;

template <class Format, bool kPair, class Op, bool kFtz, bool kSat, bool kRelu>
constexpr OpRow arithmetic_row() {
  const Examples examples = Op::template examples<Format>({.ftz = kFtz, .sat = kSat, .relu = kRelu});
  OpRow out;
  out.name = joined<Op::kName, ".rn", when<kFtz, ".ftz">, when<kSat, ".sat">, when<kRelu, ".relu">,
                    suffix<Format, kPair>>;
  out.unit = Unit::Fp16;
  out.operands = {Dst32, Src32, Src32};
  if constexpr (Op::kSources == 3) out.operands = {Dst32, Src32, Src32, Src32};
  out.run = &Arithmetic<Format, kPair, Op, kFtz, kSat, kRelu>::run;
  out.doc = joined<Op::kDoc, pair_words<kPair>, round_words<Round::Nearest>, when<kFtz, kFtzWords>,
                   when<kSat, kSatWords>, when<kRelu, kReluWords>, ".">;
  out.examples = kPair ? paired(examples) : examples;
  return out;
}
template <class Format, bool kPair, class Op>
constexpr auto two_source_rows = generated<Format::kHasFtz ? 4 : 1>([](auto i) {
  return arithmetic_row<Format, kPair, Op, i / 2, i % 2, false>();
});
template <class Format, bool kPair>
constexpr auto fma_rows = generated<Format::kHasFtz ? 6 : 2>([](auto i) {
  return arithmetic_row < Format, kPair, Fma, i / 3, Format::kHasFtz && i % 3 == 1,
         Format::kHasFtz ? i % 3 == 2 : i == 1 > ();
});

template <class Format, bool kPair, bool kMax, bool kFtz, bool kNanWins, bool kXorsign>
constexpr OpRow extreme_row() {
  constexpr uint32_t kOne = Format::kOne, kOther = kNanWins ? kNan : kOne, kSmall = kFtz ? 0 : 1;
  constexpr uint32_t kZeros = kMax && !kXorsign ? 0 : kSign;
  constexpr uint32_t kSigned = kXorsign || !kMax ? kSign | kSmall : kSmall;
  return row<kPair, 2>(
      joined<when<kMax, "max">, when<!kMax, "min">, when<kFtz, ".ftz">, when<kNanWins, ".NaN">,
             when<kXorsign, ".xorsign.abs">, suffix<Format, kPair>>,
      joined<when<kMax, "Returns the larger source">, when<!kMax, "Returns the smaller source">,
             when<kXorsign, " magnitude, with the product of the signs">, pair_words<kPair>,
             ". -0 counts as less than +0, ", when<kNanWins, "and a NaN wins">,
             when<!kNanWins, "and a NaN loses against a number">, when<kFtz, kFtzWords>, ".">,
      Extreme<Format, kMax, kFtz, kNanWins, kXorsign>{},
      {{{Format::kInfinity + 1, kOne}, kOther},
       {{kOne, Format::kInfinity + 1}, kOther},
       {{kNan, kNan | kSign}, kNan},
       {{0, kSign}, kZeros},
       {{1, kSign | 1}, kSigned},
       {{kOne, Format::kTwo}, kMax ? Format::kTwo : kOne}});
}
template <class Format, bool kPair, bool kMax>
constexpr auto extreme_rows = generated<Format::kHasFtz ? 8 : 4>([](auto i) {
  return extreme_row<Format, kPair, kMax, i / 4, i / 2 % 2, i % 2>();
});

template <class Format, bool kPair, bool kAbs>
constexpr auto sign_rows = generated<Format::kHasFtz ? 2 : 1>([](auto i) {
  constexpr bool kFtz = i == 1;
  constexpr uint32_t kOne = Format::kOne, kSmall = kFtz ? 0 : 1, kFlip = kAbs ? 0 : kSign;
  return row<kPair, 1>(
      joined<when<kAbs, "abs">, when<!kAbs, "neg">, when<kFtz, ".ftz">, suffix<Format, kPair>>,
      joined<when<kAbs, "Returns the magnitude">, when<!kAbs, "Negates">, pair_words<kPair>,
             when<kFtz, kFtzWords>, ".">,
      Sign<Format, kAbs, kFtz>{},
      {{{kOne}, kOne | kFlip}, {{kSign | kOne}, kOne}, {{1}, kSmall | kFlip}, {{kNan | kSign}, kNan}});
});

template <class Format, bool kPair>
constexpr auto format_rows = joined_rows(two_source_rows<Format, kPair, Add>,
                                         two_source_rows<Format, kPair, Subtract>,
                                         two_source_rows<Format, kPair, Multiply>, fma_rows<Format, kPair>,
                                         extreme_rows<Format, kPair, false>,
                                         extreme_rows<Format, kPair, true>, sign_rows<Format, kPair, false>,
                                         sign_rows<Format, kPair, true>);
constexpr auto kRows = joined_rows(format_rows<F16, false>, format_rows<F16, true>, format_rows<Bf16, false>,
                                   format_rows<Bf16, true>);

}  // namespace

RowList half_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
