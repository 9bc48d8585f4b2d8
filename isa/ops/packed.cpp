// Defines ops on all bytes or half words of a register: dot products, pairs of 16-bit integers, video ops.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "isa/integer_kernels.h"
#include "isa/ops/families.h"
#include "isa/ops/modifiers.h"
#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Returns part i of a word as a number of 32 bits.
template <int kPartBits, bool kSigned>
[[gnu::always_inline]] inline int32_t part_of(uint32_t x, int i) {
  const uint32_t top = x << (32 - kPartBits * (i + 1));
  return kSigned ? int32_t(top) >> (32 - kPartBits) : int32_t(top >> (32 - kPartBits));
}

// Adds sums of products modulo 2^32.
template <bool kSignedA, bool kSignedB>
inline uint32_t dot4(uint32_t a, uint32_t b, uint32_t c) {
  for (int i = 0; i < 4; ++i) c += uint32_t(part_of<8, kSignedA>(a, i) * part_of<8, kSignedB>(b, i));
  return c;
}
template <bool kSignedA, bool kSignedB, bool kHigh>
inline uint32_t dot2(uint32_t a, uint32_t b, uint32_t c) {
  for (int i = 0; i < 2; ++i)
    c += uint32_t(part_of<16, kSignedA>(a, i) * part_of<8, kSignedB>(b, i + (kHigh ? 2 : 0)));
  return c;
}
template <Text kTypes, bool kSignedA, bool kSignedB>
constexpr auto dot_rows() {
  constexpr uint64_t kA = kSignedA ? 0xffff'ffff : 255, kB = kSignedB ? 0xffff'ffff : 255;  // a byte of ones
  return joined_rows(
      ternary<uint32_t>(joined<"dp4a", kTypes>, Unit::Int,
                        "Adds the products of the four bytes and the third source.",
                        [](uint32_t a, uint32_t b, uint32_t c) { return dot4<kSignedA, kSignedB>(a, b, c); },
                        {{{0x0403'0201, 0x0101'0101, 5}, 15}, {{0xff, 1, 0}, kA}, {{1, 0xff, 0}, kB}}),
      ternary<uint32_t>(
          joined<"dp2a.lo", kTypes>, Unit::Int,
          "Adds the products of two 16-bit numbers with the low two bytes of the second, and the third "
          "source.",
          [](uint32_t a, uint32_t b, uint32_t c) { return dot2<kSignedA, kSignedB, false>(a, b, c); },
          {{{0x0002'0001, 0x0707'0403, 5}, 16}, {{1, 0xff, 0}, kB}}),
      ternary<uint32_t>(
          joined<"dp2a.hi", kTypes>, Unit::Int,
          "Adds the products of two 16-bit numbers with the high two bytes of the second, and the third "
          "source.",
          [](uint32_t a, uint32_t b, uint32_t c) { return dot2<kSignedA, kSignedB, true>(a, b, c); },
          {{{0x0002'0001, 0x0403'0707, 5}, 16}, {{1, 0xff'0000, 0}, kB}}));
}

template <bool kSigned, class F>
[[gnu::always_inline]] inline uint32_t each_half(uint32_t a, uint32_t b, F f) {
  const uint32_t low = uint32_t(f(part_of<16, kSigned>(a, 0), part_of<16, kSigned>(b, 0)));
  const uint32_t high = uint32_t(f(part_of<16, kSigned>(a, 1), part_of<16, kSigned>(b, 1)));
  return high << 16 | (low & 0xffff);
}
struct Sum {
  int32_t operator()(int32_t a, int32_t b) const { return a + b; }
};
struct Smaller {
  int32_t operator()(int32_t a, int32_t b) const { return a < b ? a : b; }
};
struct Larger {
  int32_t operator()(int32_t a, int32_t b) const { return a > b ? a : b; }
};
template <class F>
struct AtLeastZero {
  int32_t operator()(int32_t a, int32_t b) const { return Larger{}(F{}(a, b), 0); }
};
template <Text kOp, Text kType, bool kSigned, class F>
constexpr OpRow halves_row(std::string_view doc, Examples examples) {
  return binary<uint32_t>(
      joined<kOp, kType>, Unit::Int, doc,
      [](uint32_t a, uint32_t b) { return each_half<kSigned>(a, b, F{}); }, examples);
}
constexpr auto kHalvesRows = joined_rows(
    halves_row<"add", ".s16x2", true, Sum>("Adds both halves, each modulo 2^16.",
                                           {{{0x1'0002, 0x3'0004}, 0x4'0006}, {{0xffff, 1}, 0}}),
    halves_row<"add", ".u16x2", false, Sum>("Adds both halves, each modulo 2^16.",
                                            {{{0x1'0002, 0x3'0004}, 0x4'0006}, {{0xffff, 1}, 0}}),
    halves_row<"min", ".s16x2", true, Smaller>(
        "Returns the smaller number in both halves.",
        {{{0x1'0002, 0x3'0001}, 0x1'0001}, {{0xffff'0001, 1}, 0xffff'0001}}),
    halves_row<"min", ".u16x2", false, Smaller>("Returns the smaller number in both halves.",
                                                {{{0x1'0002, 0x3'0001}, 0x1'0001}, {{0xffff'0001, 1}, 1}}),
    halves_row<"max", ".s16x2", true, Larger>("Returns the larger number in both halves.",
                                              {{{0x1'0002, 0x3'0001}, 0x3'0002}, {{0xffff'0001, 1}, 1}}),
    halves_row<"max", ".u16x2", false, Larger>(
        "Returns the larger number in both halves.",
        {{{0x1'0002, 0x3'0001}, 0x3'0002}, {{0xffff'0001, 1}, 0xffff'0001}}),
    halves_row<"min.relu", ".s16x2", true, AtLeastZero<Smaller>>(
        "Returns the smaller number in both halves, but at least 0.",
        {{{0x1'0002, 0x3'0001}, 0x1'0001}, {{0xffff'0001, 1}, 1}}),
    halves_row<"max.relu", ".s16x2", true, AtLeastZero<Larger>>(
        "Returns the larger number in both halves, but at least 0.",
        {{{0x1'0002, 0x3'0001}, 0x3'0002}, {{0xffff'fffe, 0xffff'ffff}, 0}}));

// The video ops compute without limit. Then they keep the low bits, or (.sat) clamp to the result's type.
struct VideoAdd {
  static constexpr auto kName = Text("vadd");
  static constexpr uint64_t kOfFiveThree = 8;
  template <class W>
  static W apply(W a, W b) {
    return a + b;
  }
};
struct VideoSubtract {
  static constexpr auto kName = Text("vsub");
  static constexpr uint64_t kOfFiveThree = 2;
  template <class W>
  static W apply(W a, W b) {
    return a - b;
  }
};
struct VideoDistance {
  static constexpr auto kName = Text("vabsdiff");
  static constexpr uint64_t kOfFiveThree = 2;
  template <class W>
  static W apply(W a, W b) {
    return a < b ? b - a : a - b;
  }
};
struct VideoMin {
  static constexpr auto kName = Text("vmin");
  static constexpr uint64_t kOfFiveThree = 3;
  template <class W>
  static W apply(W a, W b) {
    return a < b ? a : b;
  }
};
struct VideoMax {
  static constexpr auto kName = Text("vmax");
  static constexpr uint64_t kOfFiveThree = 5;
  template <class W>
  static W apply(W a, W b) {
    return a > b ? a : b;
  }
};
// Rounds half up, because PTX says (a + b + 1) >> 1.
struct VideoAverage {
  static constexpr auto kName = Text("vavrg");
  static constexpr uint64_t kOfFiveThree = 4;
  template <class W>
  static W apply(W a, W b) {
    return (a + b + 1) >> 1;
  }
};

template <bool kSigned, class W>
[[gnu::always_inline]] inline W clamped_to(W x, int bits) {
  const W low = kSigned ? -(W(1) << (bits - 1)) : W(0);
  const W high = (W(1) << (kSigned ? bits - 1 : bits)) - 1;
  const W above = x < low ? low : x;
  return above > high ? high : above;
}
constexpr std::string_view kVideoDoc =
    "Computes what the name says on numbers of the sources' types. .sat clamps to the type of the result; "
    "without it the low bits stay.";

// Does the work of a row, which is named elsewhere. Without .sat the type of the result makes no difference.
template <class Op, class A, class B, bool kSat, bool kSignedResult>
struct ScalarWork {
  uint32_t operator()(A a, B b) const {
    const int64_t exact = Op::apply(int64_t(a), int64_t(b));
    return uint32_t(kSat ? clamped_to<kSignedResult>(exact, 32) : exact);
  }
};
// These work on whole registers. D.A.B name the types of the result and of the sources.
template <class Op, class D, class A, class B, bool kSat>
constexpr OpRow scalar_row() {
  using From = typename A::Type;
  using Other = typename B::Type;
  return value_op<From, Other>(joined<Op::kName, D::kName, A::kName, B::kName, when<kSat, ".sat">>, Unit::Int,
                               kVideoDoc, ScalarWork < Op, From, Other, kSat,
                               kSat && std::is_signed_v < typename D::Type >> {},
                               {{{5, 3}, Op::kOfFiveThree}, {{0, 0}, 0}});
}
template <class Op>
constexpr auto scalar_rows() {
  return rows_of_types<TypeS32, TypeU32>([]<class D>() {
    return rows_of_types<TypeS32, TypeU32>([]<class A>() {
      return rows_of_types<TypeS32, TypeU32>([]<class B>() {
        return joined_rows(scalar_row<Op, D, A, B, false>(), scalar_row<Op, D, A, B, true>());
      });
    });
  });
}

// These work on two half words or four bytes. The third source gives the parts that a mask leaves out (here
// none) or, with .add, a number to which all results are added.
enum class Video { Plain, Saturating, Accumulating };
template <class Op, int kPartBits, bool kSigned, Video kKind, bool kSignedResult>
struct PartsWork {
  uint32_t operator()(uint32_t a, uint32_t b, uint32_t c) const {
    constexpr uint32_t kMask = (1u << kPartBits) - 1;
    uint32_t out = kKind == Video::Accumulating ? c : 0;
    for (int i = 0; i < 32 / kPartBits; ++i) {
      const int32_t exact = Op::apply(part_of<kPartBits, kSigned>(a, i), part_of<kPartBits, kSigned>(b, i));
      if constexpr (kKind == Video::Accumulating)
        out += uint32_t(exact);
      else if constexpr (kKind == Video::Saturating)
        out |= (uint32_t(clamped_to<kSignedResult>(exact, kPartBits)) & kMask) << (kPartBits * i);
      else
        out |= (uint32_t(exact) & kMask) << (kPartBits * i);
    }
    return out;
  }
};
template <class Op, Text kParts, int kPartBits, class D, class A, Video kKind>
constexpr OpRow parts_row() {
  constexpr bool kSigned = std::is_signed_v<typename A::Type>;
  constexpr uint64_t kEach = Op::kOfFiveThree, kPair = kEach << 16 | kEach;
  constexpr uint64_t kWord = kPartBits == 16 ? kPair : kPair << 8 | kPair,
                     kScale = kPartBits == 16 ? 0x1'0001 : 0x101'0101;
  constexpr bool kAdds = kKind == Video::Accumulating;
  return ternary<uint32_t>(
      joined<Op::kName, kParts, D::kName, A::kName, A::kName, when<kKind == Video::Saturating, ".sat">,
             when<kAdds, ".add">>,
      Unit::Int,
      kAdds ? "Adds the op's results for all parts of the sources, and the third source." : kVideoDoc,
      PartsWork < Op, kPartBits, kSigned, kKind,
      kKind == Video::Saturating && std::is_signed_v < typename D::Type >> {},
      {{{5 * kScale, 3 * kScale, 7}, kAdds ? 32 / kPartBits * kEach + 7 : kWord}, {{0, 0, 0}, 0}});
}
template <class Op, Text kParts, int kPartBits>
constexpr auto parts_rows() {
  return rows_of_types<TypeS32, TypeU32>([]<class D>() {
    return rows_of_types<TypeS32, TypeU32>([]<class A>() {
      return joined_rows(parts_row<Op, kParts, kPartBits, D, A, Video::Plain>(),
                         parts_row<Op, kParts, kPartBits, D, A, Video::Saturating>(),
                         parts_row<Op, kParts, kPartBits, D, A, Video::Accumulating>());
    });
  });
}

constexpr auto kRows = joined_rows(
    dot_rows<".s32.s32", true, true>(), dot_rows<".s32.u32", true, false>(),
    dot_rows<".u32.s32", false, true>(), dot_rows<".u32.u32", false, false>(), kHalvesRows,
    rows_of_types<VideoAdd, VideoSubtract, VideoDistance, VideoMin, VideoMax>(
        []<class Op>() { return scalar_rows<Op>(); }),
    rows_of_types<VideoAdd, VideoSubtract, VideoDistance, VideoMin, VideoMax, VideoAverage>(
        []<class Op>() { return joined_rows(parts_rows<Op, "2", 16>(), parts_rows<Op, "4", 8>()); }));

}  // namespace

RowList packed_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
