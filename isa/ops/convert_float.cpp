// Defines conversions between floats of 16, 32 and 64 bits, and rounding to integers.
// SPDX-License-Identifier: Apache-2.0
#include "isa/half_rows.h"
#include "isa/ops/conversion_types.h"
#include "isa/ops/families.h"
#include "isa/rounded_arithmetic.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

inline float with_sign_of(float magnitude, float x) {
  return float_of((float_bits(magnitude) & 0x7fff'ffffu) | (float_bits(x) & 0x8000'0000u));
}
template <Round kRound>
inline float rounded_whole(float x) {
  if constexpr (kRound == Round::Nearest) return round_even(x);
  if constexpr (kRound == Round::Zero) {
    const float magnitude = float_of(float_bits(x) & 0x7fff'ffffu), r = round_even(magnitude);
    return canonical(with_sign_of(r > magnitude ? r - 1.0f : r, x));
  }
  const float r = round_even(x);
  if constexpr (kRound == Round::Down) return canonical(with_sign_of(r > x ? r - 1.0f : r, x));
  return canonical(with_sign_of(r < x ? r + 1.0f : r, x));
}

template <Round kRound>
inline constexpr uint64_t kWholeSingle = kRound == Round::Up ? 0x4040'0000 : 0x4000'0000;  // of 2.5
template <Round kRound>
inline constexpr uint64_t kMinusHalf = kRound == Round::Down ? 0xbf80'0000 : 0x8000'0000;  // of -0.5

template <Round kRound, bool kFtz, bool kSat>
constexpr OpRow whole_single_row() {
  return unary<float>(
      joined<"cvt", integer_round_name<kRound>, when<kFtz, ".ftz">, when<kSat, ".sat">, ".f32.f32">,
      Unit::Sfu,
      kSat ? "Rounds to an integer that stays a float, and clamps it to [0, 1]. NaN becomes 0."
           : "Rounds to an integer that stays a float.",
      [](float x) {
        const float whole = rounded_whole<kRound>(kFtz ? flushed(x) : x);
        return kSat ? saturated(whole) : whole;
      },
      {{{0x4020'0000}, kSat ? 0x3f80'0000 : kWholeSingle<kRound>},
       {{0xbf00'0000}, kSat ? 0 : kMinusHalf<kRound>},
       {{1}, kRound == Round::Up && !kFtz ? 0x3f80'0000u : 0u},
       {{0x4b00'0001}, kSat ? 0x3f80'0000 : 0x4b00'0001},
       {{0x7f80'0001}, kSat ? 0 : kCanonicalNan}});
}
template <Round kRound, bool kSat>
constexpr OpRow whole_double_row() {
  constexpr uint64_t kRounded = kRound == Round::Up ? 0x4008ull << 48 : 0x4000ull << 48;  // of 2.5
  return unary<double>(joined<"cvt", integer_round_name<kRound>, when<kSat, ".sat">, ".f64.f64">, Unit::Sfu,
                       "Rounds to an integer that stays a float.",
                       [](double x) {
                         const double whole = to_any_integral<kRound>(x);
                         return kSat ? saturated(whole) : whole;
                       },
                       {{{TypeF64::kOne}, TypeF64::kOne},
                        {{TypeF64::kTwoAndHalf}, kSat ? TypeF64::kOne : kRounded},
                        {{TypeF64::kMinusOne}, kSat ? 0 : TypeF64::kMinusOne}});
}
template <Round kRound, bool kSat>
constexpr OpRow whole_half_row() {
  constexpr uint64_t kRounded = kRound == Round::Up ? 0x4200 : 0x4000;  // of 2.5
  return unary<Half>(joined<"cvt", integer_round_name<kRound>, when<kSat, ".sat">, ".f16.f16">, Unit::Sfu,
                     "Rounds to an integer that stays a float.",
                     [](Half x) {
                       const float whole = rounded_whole<kRound>(to_float(x));
                       return to_half(kSat ? saturated(whole) : whole);
                     },
                     {{{TypeF16::kOne}, TypeF16::kOne},
                      {{TypeF16::kTwoAndHalf}, kSat ? TypeF16::kOne : kRounded},
                      {{TypeF16::kMinusOne}, kSat ? 0 : TypeF16::kMinusOne}});
}

// These keep the width and do not round: they flush or clamp.
constexpr auto same_rows() {
  return joined_rows(
      unary<float>("cvt.sat.f32.f32", Unit::Int, "Clamps to [0, 1]. NaN becomes 0.",
                   [](float x) { return saturated(x); },
                   {{{0x4000'0000}, 0x3f80'0000}, {{1}, 1}, {{0x7fc0'0000}, 0}, {{0xbf80'0000}, 0}}),
      unary<float>(
          "cvt.ftz.f32.f32", Unit::Int, "Turns subnormals into zeros.",
          [](float x) { return canonical(flushed(x)); },
          {{{0x4000'0000}, 0x4000'0000}, {{0x8000'0001}, 0x8000'0000}, {{0x7f80'0001}, 0x7fff'ffff}}),
      unary<float>("cvt.ftz.sat.f32.f32", Unit::Int, "Clamps to [0, 1]. Subnormals and NaN become 0.",
                   [](float x) { return saturated(flushed(x)); }, {{{0x4000'0000}, 0x3f80'0000}, {{1}, 0}}),
      unary<double>("cvt.sat.f64.f64", Unit::Sfu, "Clamps to [0, 1]. NaN becomes 0.",
                    [](double x) { return saturated(x); },
                    {{{TypeF64::kTwoAndHalf}, TypeF64::kOne}, {{TypeF64::kNan}, 0}}),
      unary<Half>("cvt.sat.f16.f16", Unit::Int, "Clamps to [0, 1]. NaN becomes 0.",
                  [](Half x) { return to_half(saturated(to_float(x))); },
                  {{{TypeF16::kTwoAndHalf}, TypeF16::kOne}, {{TypeF16::kNan}, 0}}));
}

// Converts to a wider type, which is exact.
template <class D, class S, bool kFtz, bool kSat>
constexpr OpRow wider_row() {
  using To = typename D::Type;
  return value_op<typename S::Type>(
      joined<"cvt", when<kFtz, ".ftz">, when<kSat, ".sat">, D::kName, S::kName>,
      sizeof(To) == 8 ? Unit::Sfu : Unit::Int,
      kSat ? "Widens a float and clamps it to [0, 1]. NaN becomes 0." : "Widens a float exactly.",
      [](typename S::Type x) {
        constexpr bool kFlush = kFtz && std::is_same_v<S, TypeF32>;  // a 16-bit subnormal is a normal f32
        // Recordings show that flushing makes the NaN of single precision, and so does f16 to f32. Otherwise
        // the payload stays.
        const float source = kFlush ? canonical(flushed(S::value(x))) : S::value(x);
        const To wide = To(std::is_same_v<S, TypeF16> && sizeof(To) == 4 ? canonical(source) : source);
        return kSat ? saturated(wide) : wide;
      },
      {{{S::kOne}, D::kOne},
       {{S::kTwoAndHalf}, kSat ? D::kOne : D::kTwoAndHalf},
       {{S::kMinusOne}, kSat ? 0 : D::kMinusOne}});
}
template <class D, class S>
constexpr auto wider_rows() {
  return joined_rows(wider_row<D, S, false, false>(), wider_row<D, S, false, true>());
}
template <class D, class S>
constexpr auto wider_flushing_rows() {
  return joined_rows(wider_rows<D, S>(), wider_row<D, S, true, false>(), wider_row<D, S, true, true>());
}

// Converts to a narrower type. From double to single the host rounds, and a NaN keeps the part of its payload
// that fits.
template <Round kRound, bool kFtz, bool kSat>
constexpr OpRow single_row() {
  return rounded_op<kRound, Narrowing, double>(
      joined<"cvt", round_name<kRound>, when<kFtz, ".ftz">, when<kSat, ".sat">, ".f32.f64">, Unit::Sfu,
      kSat ? "Narrows a float and clamps it to [0, 1]. NaN becomes 0."
           : "Narrows a float. A NaN keeps the part of its payload that fits.",
      [](float narrow, double) {
        const float kept = kFtz ? flushed(narrow) : narrow;
        return kSat ? saturated(kept) : kept;
      },
      {{{TypeF64::kOne}, TypeF32::kOne},
       {{TypeF64::kTwoAndHalf}, kSat ? TypeF32::kOne : TypeF32::kTwoAndHalf},
       {{0x3fb9'9999'9999'999a},
        kRound == Round::Zero || kRound == Round::Down ? 0x3dcc'cccc : 0x3dcc'cccd},  // 0.1
       {{0x7ff4'dead'beef'1234}, kSat ? 0 : 0x7fe6'f56d}});
}

// Returns the narrowed NaN of a double. Recordings show that it keeps its sign and payload and becomes quiet.
template <class D>
inline uint32_t narrowed_nan(double nan) {
  constexpr int kPayload = std::is_same_v<D, TypeBf16> ? 7 : 10;  // bits
  constexpr uint32_t kQuiet = uint32_t(D::kInfinity) | 1u << (kPayload - 1), kMask = (1u << kPayload) - 1;
  const uint64_t bits = double_bits(nan);
  return uint32_t(bits >> 48 & 0x8000) | kQuiet | (uint32_t(bits >> (52 - kPayload)) & kMask);
}
// Handles a row: clamps where the name says so and rounds to 16 bits, a row at a time. Doubles come as floats
// rounded to odd, so that the second rounding is the only one that counts. Recordings show that .ftz changes
// nothing: a subnormal still rounds up or down to the least f16.
template <class D, class S, Round kRound, bool kSat, bool kRelu>
[[gnu::flatten]] void run_narrow(Warp& warp, const Inst& inst, const OpRow& row) {
  if (ran_some_lanes<uint32_t>(warp, inst, row, &run_narrow<D, S, kRound, kSat, kRelu>)) return;
  constexpr bool kFromDouble = std::is_same_v<S, TypeF64>;
  const Slot* const slot = &inst.operand.front();
  const Source<typename S::Type> source(warp, slot[1]);
  alignas(64) float x[kLanes];
  alignas(64) uint32_t out[kLanes];
  if constexpr (kFromDouble)
    odd_floats(source, x);
  else
    all_lanes([&](int i) { x[i] = source.at(i); });
  if constexpr (kSat) all_lanes([&](int i) { x[i] = saturated(x[i]); });
  if constexpr (kRelu) all_lanes([&](int i) { x[i] = x[i] <= 0.0f ? 0.0f : x[i]; });  // a NaN stays
  if constexpr (std::is_same_v<D, TypeF16>)
    narrow_to_halves<kRound>(x, out);
  else
    all_lanes([&](int i) { out[i] = rounded_bfloat<kRound>(x[i]).bits; });
  write_all_lanes<uint32_t>(warp, slot[0], [&](int i) {
    if constexpr (!kFromDouble || kSat) return out[i];
    const double number = source.at(i);
    return number != number ? narrowed_nan<D>(number) : out[i];
  });
}
template <class D, class S, Round kRound, bool kFtz, bool kSat, bool kRelu>
constexpr OpRow narrow_row() {
  OpRow row;
  row.name = joined<"cvt", round_name<kRound>, when<kFtz, ".ftz">, when<kSat, ".sat">, when<kRelu, ".relu">,
                    D::kName, S::kName>;
  row.operands = {Dst32, source_kind<typename S::Type>()};
  row.run = &run_narrow<D, S, kRound, kSat, kRelu>;
  row.doc = kSat    ? "Narrows a float, rounds as the name says, and clamps to [0, 1]. NaN becomes 0."
            : kRelu ? "Narrows a float and rounds as the name says. Negative numbers become 0."
                    : "Narrows a float and rounds as the name says.";
  row.examples = {{{S::kOne}, D::kOne},
                  {{S::kTwoAndHalf}, kSat ? D::kOne : D::kTwoAndHalf},
                  {{S::kMinusOne}, kSat || kRelu ? 0 : D::kMinusOne}};
  return row;
}
template <class D, class S>
constexpr auto rounded_rows() {
  return rows_of_rounds(
      []<Round kRound>() { return joined_rows(narrow_row<D, S, kRound, false, false, false>()); });
}
template <class D, class S, bool kFtz>
constexpr auto saturating_rows() {
  return rows_of_rounds(
      []<Round kRound>() { return joined_rows(narrow_row<D, S, kRound, kFtz, true, false>()); });
}
template <class D>
constexpr auto relu_rows() {
  return joined_rows(narrow_row<D, TypeF32, Round::Nearest, false, false, true>(),
                     narrow_row<D, TypeF32, Round::Zero, false, false, true>());
}

constexpr auto kWholeRows = rows_of_rounds([]<Round kRound>() {
  return joined_rows(whole_single_row<kRound, false, false>(), whole_single_row<kRound, false, true>(),
                     whole_single_row<kRound, true, false>(), whole_single_row<kRound, true, true>(),
                     whole_double_row<kRound, false>(), whole_double_row<kRound, true>(),
                     whole_half_row<kRound, false>(), whole_half_row<kRound, true>());
});
constexpr auto kSingleRows = rows_of_rounds([]<Round kRound>() {
  return joined_rows(single_row<kRound, false, false>(), single_row<kRound, false, true>(),
                     single_row<kRound, true, false>(), single_row<kRound, true, true>());
});
constexpr auto kNarrowRows =
    joined_rows(rounded_rows<TypeF16, TypeF32>(), saturating_rows<TypeF16, TypeF32, false>(),
                rows_of_rounds([]<Round kRound>() {
                  return joined_rows(narrow_row<TypeF16, TypeF32, kRound, true, false, false>());
                }),
                saturating_rows<TypeF16, TypeF32, true>(), rounded_rows<TypeF16, TypeF64>(),
                saturating_rows<TypeF16, TypeF64, false>(), rounded_rows<TypeBf16, TypeF32>(),
                rounded_rows<TypeBf16, TypeF64>(), relu_rows<TypeF16>(), relu_rows<TypeBf16>());
constexpr auto kWiderRows = joined_rows(
    wider_flushing_rows<TypeF64, TypeF32>(), wider_flushing_rows<TypeF32, TypeF16>(),
    wider_rows<TypeF64, TypeF16>(), wider_rows<TypeF32, TypeBf16>(), wider_rows<TypeF64, TypeBf16>());
constexpr auto kRows = joined_rows(kWholeRows, same_rows(), kWiderRows, kSingleRows, kNarrowRows);

}  // namespace

RowList convert_float_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
