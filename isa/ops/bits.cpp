// Defines bit fields, counts, permutations and three-input logic.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "isa/integer_kernels.h"
#include "isa/ops/families.h"
#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

template <class N>
constexpr auto count_rows() {
  using T = typename N::Type;
  constexpr uint64_t kOnes = word(T(-1)), kWidth = kBits<T>, kHigh = word(T(T(1) << (kWidth - 1)));
  return joined_rows(
      unary<T>(joined<"popc", N::kName>, Unit::Sfu, "Counts the ones.", [](T a) { return count_ones(a); },
               {{{0}, 0}, {{kOnes}, kWidth}, {{kHigh | 1}, 2}}),
      unary<T>(joined<"clz", N::kName>, Unit::Sfu, "Counts the leading zeros. For 0 the result is the width.",
               [](T a) { return uint32_t(kBits<T> - 1) - highest_one(a); },
               {{{0}, kWidth}, {{1}, kWidth - 1}, {{kHigh}, 0}}),
      unary<T>(joined<"brev", N::kName>, Unit::Sfu, "Reverses the order of the bits.",
               [](T a) { return reversed(a); },
               {{{1}, kHigh}, {{kOnes}, kOnes}, {{0xf1}, 0x8full << (kWidth - 8)}}));
}

// Returns the bits that differ from the sign. For unsigned types all bits stay.
template <class T>
inline Unsigned<T> significant(T a) {
  if constexpr (std::is_signed_v<T>)
    return Unsigned<T>(a ^ (a >> (kBits<T> - 1)));
  else
    return a;
}
template <class N>
constexpr auto find_rows() {
  using T = typename N::Type;
  constexpr uint64_t kOnes = word(T(-1)), kTop = kBits<T> - 1, kNone = 0xffff'ffff;
  constexpr bool kSigned = std::is_signed_v<T>;
  return joined_rows(
      unary<T>(joined<"bfind", N::kName>, Unit::Sfu,
               kSigned ? "Returns the position of the highest bit that differs from the sign, or all ones if "
                         "none does."
                       : "Returns the position of the highest one, or all ones for 0.",
               [](T a) { return highest_one(significant(a)); },
               {{{0}, kNone}, {{1}, 0}, {{kOnes}, kSigned ? kNone : kTop}, {{0x40}, 6}}),
      unary<T>(joined<"bfind.shiftamt", N::kName>, Unit::Sfu,
               "Returns the shift left that brings the bit found by bfind to the top, or all ones if there "
               "is none.",
               [](T a) {
                 const uint32_t at = highest_one(significant(a));
                 return at > 63 ? at : uint32_t(kBits<T> - 1) - at;
               },
               {{{0}, kNone}, {{1}, kTop}, {{kOnes}, kSigned ? kNone : 0}, {{0x40}, kTop - 6}}));
}

template <class N>
constexpr auto field_rows() {
  using T = typename N::Type;
  constexpr uint64_t kWidth = kBits<T>, kOnes = word(T(-1));
  if constexpr (std::is_signed_v<T>)
    return value_op<T, uint32_t, uint32_t>(
        joined<"bfe", N::kName>, Unit::Int,
        "Extracts a field (value, position, length) and extends its sign, which past the top is the top bit.",
        [](T a, uint32_t p, uint32_t n) { return field(a, p, n); },
        {{{0x1234'8678, 8, 8}, word(T(-122))},
         {{kOnes >> 1, kWidth - 4, 8}, 7},
         {{kOnes ^ (kOnes >> 1), kWidth + 8, 4}, kOnes},
         {{kOnes, 0, 0}, 0}});
  else
    return value_op<T, uint32_t, uint32_t>(
        joined<"bfe", N::kName>, Unit::Int,
        "Extracts a field (value, position, length). Bits beyond the top are zeros.",
        [](T a, uint32_t p, uint32_t n) { return field(a, p, n); },
        {{{0x1234'5678, 8, 12}, 0x456},
         {{kOnes, kWidth - 4, 8}, 0xf},
         {{kOnes, 0, 0}, 0},
         {{kOnes, kWidth + 8, 4}, 0}});
}
template <class N>
constexpr auto insert_rows() {
  using T = typename N::Type;
  constexpr uint64_t kWidth = kBits<T>;
  return value_op<T, T, uint32_t, uint32_t>(
      joined<"bfi", N::kName>, Unit::Int,
      "Inserts a field. The sources are field, background, position, length.",
      [](T a, T b, uint32_t p, uint32_t n) { return inserted(a, b, p, n); },
      {{{0xab, 0x1111'1111, 8, 8}, 0x1111'ab11},
       {{0xff, 0, kWidth - 4, 8}, word(T(T(0xf) << (kWidth - 4)))},
       {{0xff, 5, 0, 0}, 5},
       {{0xff, 5, kWidth, 4}, 5}});
}

// Shifts the pair b:a, where b is the high half. Counts of .wrap are modulo 32, and counts of .clamp are at
// most 32.
template <bool kClamp>
inline uint32_t funnel_left(uint32_t a, uint32_t b, uint32_t n) {
  const uint32_t shifted = (b << (n & 31)) | ((a >> 1) >> (31 - (n & 31)));
  return kClamp && n > 31 ? a : shifted;
}
template <bool kClamp>
inline uint32_t funnel_right(uint32_t a, uint32_t b, uint32_t n) {
  const uint32_t shifted = ((b << 1) << (31 - (n & 31))) | (a >> (n & 31));
  return kClamp && n > 31 ? b : shifted;
}

// Looks up the truth table of three inputs, whose bit 4a + 2b + c is the result. It chooses by c, then b,
// then a.
inline uint32_t looked_up(uint32_t a, uint32_t b, uint32_t c, uint32_t table) {
  const auto entry = [&](int i) { return 0u - ((table >> i) & 1); };
  const auto choice = [](uint32_t by, uint32_t zero, uint32_t one) { return zero ^ (by & (zero ^ one)); };
  const uint32_t low = choice(b, choice(c, entry(0), entry(1)), choice(c, entry(2), entry(3)));
  const uint32_t high = choice(b, choice(c, entry(4), entry(5)), choice(c, entry(6), entry(7)));
  return choice(a, low, high);
}

// Returns the position of one number n (from 0) of x, counted from the low end, for n below count_ones(x).
inline uint32_t position_of_one(uint32_t x, uint32_t n) {
  uint32_t at = 0;
  const auto halve = [&](uint32_t width) {
    const uint32_t below = count_ones((x >> at) & ((1u << width) - 1));
    const uint32_t step = n >= below ? ~0u : 0u;
    at += width & step;
    n -= below & step;
  };
  halve(16);
  halve(8);
  halve(4);
  halve(2);
  halve(1);
  return at;
}
// Finds the one number |offset| from bit `base` on, including that bit, upwards or (offset < 0) downwards
// (PTX ISA, fns). A base above 31 finds nothing. Recordings show that an offset of -2^31 gives 0.
inline uint32_t found_one(uint32_t mask, uint32_t base, int32_t offset) {
  const bool is_up = offset >= 0;
  const uint32_t from = is_up ? base : 31 - base;  // downwards is upwards in the reversed word
  const uint32_t bit = 1u << (from & 31);
  const uint32_t wanted = offset == 0 ? bit : 0u - bit;  // that bit, or all bits from it on
  const uint32_t rest = (is_up ? mask : reversed(mask)) & wanted & (from > 31 ? 0u : ~0u);
  const uint32_t distance = is_up ? uint32_t(offset) : 0u - uint32_t(offset);
  const uint32_t number = distance - (distance == 0 ? 0u : 1u);
  const uint32_t at = position_of_one(rest, number);
  const uint32_t right_way = is_up ? at : 31 - at;
  const uint32_t found = right_way | (number >= count_ones(rest) ? ~0u : 0u);
  return distance == 0x8000'0000u ? 0u : found;
}

template <bool kClamp>
inline uint32_t made_mask(uint32_t position, uint32_t length) {
  if constexpr (!kClamp) return low_ones<uint32_t>(length & 31) << (position & 31);
  return shifted_left(low_ones<uint32_t>(length), position);
}
// Extends the lowest n bits. .wrap takes n modulo 32, and .clamp takes at most 32.
template <bool kClamp, class T>
inline T extended(T a, uint32_t n) {
  const uint32_t length = kClamp ? n : n & 31;
  const uint32_t gap = length > 31 ? 0u : 32 - length;
  return length == 0 ? T(0) : T(T(uint32_t(a) << (gap & 31)) >> (gap & 31));
}
template <Text kMode, bool kClamp>
constexpr auto mode_rows() {
  return joined_rows(
      value_op<uint32_t, uint32_t, uint32_t>(
          joined<"shf.l", kMode, ".b32">, Unit::Int,
          kClamp ? "Shifts a pair (low, high) left by at most 32, and returns the high word."
                 : "Shifts a pair (low, high) left by a count modulo 32, and returns the high word.",
          [](uint32_t a, uint32_t b, uint32_t n) { return funnel_left<kClamp>(a, b, n); },
          {{{0x8000'0000, 1, 1}, 3}, {{5, 7, 0}, 7}, {{5, 7, 32}, kClamp ? 5 : 7}}),
      value_op<uint32_t, uint32_t, uint32_t>(
          joined<"shf.r", kMode, ".b32">, Unit::Int,
          kClamp ? "Shifts a pair (low, high) right by at most 32, and returns the low word."
                 : "Shifts a pair (low, high) right by a count modulo 32, and returns the low word.",
          [](uint32_t a, uint32_t b, uint32_t n) { return funnel_right<kClamp>(a, b, n); },
          {{{6, 1, 1}, 0x8000'0003}, {{5, 7, 0}, 5}, {{5, 7, 32}, kClamp ? 7 : 5}}),
      binary<uint32_t>(
          joined<"bmsk", kMode, ".b32">, Unit::Int,
          kClamp ? "Makes a mask from a position and a number of ones. Ones beyond the word are lost."
                 : "Makes a mask from a position and a number of ones, both taken modulo 32.",
          [](uint32_t a, uint32_t b) { return made_mask<kClamp>(a, b); },
          {{{4, 8}, 0xff0}, {{28, 8}, 0xf000'0000}, {{0, 32}, kClamp ? 0xffff'ffff : 0}}),
      value_op<int32_t, uint32_t>(
          joined<"szext", kMode, ".s32">, Unit::Int,
          "Extends the sign of the lowest bits. The second source gives their number.",
          [](int32_t a, uint32_t n) { return extended<kClamp>(a, n); },
          {{{0x1f8, 8}, 0xffff'fff8}, {{5, 0}, 0}, {{0x8000'0000, 32}, kClamp ? 0x8000'0000 : 0}}),
      value_op<uint32_t, uint32_t>(
          joined<"szext", kMode, ".u32">, Unit::Int,
          "Keeps the lowest bits. The second source gives their number.",
          [](uint32_t a, uint32_t n) { return extended<kClamp>(a, n); },
          {{{0x1f8, 8}, 0xf8}, {{5, 0}, 0}, {{0x8000'0000, 32}, kClamp ? 0x8000'0000 : 0}}));
}

// Returns byte number `at` (0 to 7) of a and b, with b above.
inline uint32_t byte_of(uint32_t a, uint32_t b, uint32_t at) {
  return (((at & 4) != 0 ? b : a) >> ((at & 3) * 8)) & 0xff;
}
inline uint32_t permuted(uint32_t a, uint32_t b, uint32_t selector) {
  uint32_t out = 0;
  for (int i = 0; i < 4; ++i) {
    const uint32_t pick = selector >> (4 * i);
    const uint32_t byte = byte_of(a, b, pick & 7);
    const uint32_t sign = (0u - (byte >> 7)) & 0xff;
    out |= ((pick & 8) != 0 ? sign : byte) << (8 * i);
  }
  return out;
}
// The other modes take one number n and make four selections of it (PTX ISA, prmt).
template <Text kMode, class Pick>
constexpr OpRow permute_row(std::string_view doc, Pick, Examples examples) {
  return ternary<uint32_t>(
      joined<"prmt.b32", kMode>, Unit::Int, doc,
      [](uint32_t a, uint32_t b, uint32_t n) {
        uint32_t out = 0;
        for (uint32_t i = 0; i < 4; ++i) out |= byte_of(a, b, Pick{}(n & 3, i)) << (8 * i);
        return out;
      },
      examples);
}
constexpr uint64_t kLow = 0x3322'1100, kHigh = 0x7766'5544;
constexpr auto permute_rows() {
  using U = uint32_t;
  return joined_rows(
      ternary<U>("prmt.b32", Unit::Int,
                 "Picks four bytes of eight, each by a nibble of the third source. Bit 3 of a nibble asks "
                 "for copies of "
                 "the sign.",
                 [](U a, U b, U selector) { return permuted(a, b, selector); },
                 {{{kLow, kHigh, 0x3210}, kLow},
                  {{kLow, kHigh, 0x7654}, kHigh},
                  {{kLow, 0x80, 0xc400}, 0xff80'0000}}),
      permute_row<".f4e">("Picks four bytes of eight, upwards from byte n of 0 to 3.",
                          [](U n, U i) { return n + i; },
                          {{{kLow, kHigh, 0}, kLow}, {{kLow, kHigh, 3}, 0x6655'4433}}),
      permute_row<".b4e">(
          "Picks four bytes of eight, downwards from byte n of 0 to 3. Byte 7 comes below byte 0.",
          [](U n, U i) { return (n - i) & 7; },
          {{{kLow, kHigh, 3}, 0x0011'2233}, {{kLow, kHigh, 0}, 0x5566'7700}}),
      permute_row<".rc8">("Repeats byte n of the first source four times.", [](U n, U) { return n; },
                          {{{kLow, kHigh, 0}, 0}, {{kLow, kHigh, 2}, 0x2222'2222}}),
      permute_row<".ecl">("Replaces the bytes of the first source below byte n by byte n (edge clamp left).",
                          [](U n, U i) { return i > n ? i : n; },
                          {{{kLow, kHigh, 0}, kLow}, {{kLow, kHigh, 2}, 0x3322'2222}}),
      permute_row<".ecr">("Replaces the bytes of the first source above byte n by byte n (edge clamp right).",
                          [](U n, U i) { return i < n ? i : n; },
                          {{{kLow, kHigh, 0}, 0}, {{kLow, kHigh, 2}, 0x2222'1100}}),
      permute_row<".rc16">("Repeats a half of the first source, the upper half where n is odd.",
                           [](U n, U i) { return (n & 1) * 2 + (i & 1); },
                           {{{kLow, kHigh, 0}, 0x1100'1100}, {{kLow, kHigh, 1}, 0x3322'3322}}));
}

constexpr auto kRows = joined_rows(
    rows_of_types<TypeB32, TypeB64>([]<class N>() { return count_rows<N>(); }),
    rows_of_types<TypeS32, TypeU32, TypeS64, TypeU64>([]<class N>() { return find_rows<N>(); }),
    rows_of_types<TypeS32, TypeU32, TypeS64, TypeU64>([]<class N>() { return field_rows<N>(); }),
    rows_of_types<TypeB32, TypeB64>([]<class N>() { return insert_rows<N>(); }), mode_rows<".wrap", false>(),
    mode_rows<".clamp", true>(),
    value_op<uint32_t, uint32_t, uint32_t, uint32_t>(
        "lop3.b32", Unit::Int,
        "Computes any logic of three words. Bit 4a + 2b + c of the fourth source is the result's bit.",
        [](uint32_t a, uint32_t b, uint32_t c, uint32_t table) { return looked_up(a, b, c, table); },
        {{{0xf0, 0xcc, 0xaa, 0x80}, 0x80},
         {{0xf0, 0xcc, 0xaa, 0x96}, 0x96},
         {{0xf0, 0xcc, 0xaa, 0x3c}, 0x3c}}),
    value_op<uint32_t, uint32_t, uint32_t, uint32_t>(
        "lop3.eq.b32", Unit::Int, "Computes logic of three words as lop3 does, and gives true where it is 0.",
        [](uint32_t a, uint32_t b, uint32_t c, uint32_t table) { return looked_up(a, b, c, table) == 0; },
        {{{0xf0, 0x0f, 0, 0xc0}, 1}, {{0xf0, 0x1f, 0, 0xc0}, 0}}),
    value_op<uint32_t, uint32_t, uint32_t, uint32_t>(
        "lop3.ne.b32", Unit::Int,
        "Computes logic of three words as lop3 does, and gives true where it is not 0.",
        [](uint32_t a, uint32_t b, uint32_t c, uint32_t table) { return looked_up(a, b, c, table) != 0; },
        {{{0xf0, 0x0f, 0, 0xc0}, 0}, {{0xf0, 0x1f, 0, 0xc0}, 1}}),
    value_op<uint32_t, uint32_t, uint32_t, uint32_t>(
        "lop3.both.b32", Unit::Int,
        "Computes logic of three words as lop3 does. The predicate is true where it is not 0.",
        [](uint32_t a, uint32_t b, uint32_t c, uint32_t table) {
          const uint32_t word = looked_up(a, b, c, table);
          return Two<uint32_t, bool>{word, word != 0};
        },
        {{{0xf0, 0x0f, 0, 0xc0}, 0, 0}, {{0xf0, 0x1f, 0, 0xc0}, 0x10, 1}}),
    value_op<uint32_t, uint32_t, int32_t>(
        "fns.b32", Unit::Sfu,
        "Returns the position of the n-th one from a bit on, upwards or (n < 0) downwards, or all ones if "
        "there is none. n = 0 tests the bit itself.",
        [](uint32_t mask, uint32_t base, int32_t offset) { return found_one(mask, base, offset); },
        {{{0xaaaa'aaaa, 3, 1}, 3},
         {{0xaaaa'aaaa, 3, 2}, 5},
         {{0xaaaa'aaaa, 3, 0xffff'fffe}, 1},
         {{0xaaaa'aaaa, 2, 0}, 0xffff'ffff}}),
    permute_rows());

}  // namespace

RowList bits_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
