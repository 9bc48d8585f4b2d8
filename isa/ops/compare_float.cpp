// Defines comparisons of floats. A comparison with a NaN is false, except for relations that end in u.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "isa/half.h"
#include "isa/ops/comparisons.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Gives the opposites of ordered relations, which are true with a NaN.
template <class Test>
struct Not {
  bool operator()(auto a, auto b) const { return !Test{}(a, b); }
};
struct IsLessOrGreater {
  bool operator()(auto a, auto b) const { return bool((a < b) | (a > b)); }
};
struct IsOrdered {
  bool operator()(auto a, auto b) const { return bool((a <= b) | (a > b)); }
};

// Describes a float operand: its type, its flush modifier, and the number that is compared.
struct SinglePrecision : Named<float, ".f32"> {
  static constexpr auto kFlush = Text("");
  static constexpr Unit kUnit = Unit::Fp32;
  static constexpr uint64_t kOne = 0x3f80'0000, kTwo = 0x4000'0000, kNan = 0x7fc0'0000;
  [[gnu::always_inline]] static float value(float x) { return x; }
};
struct FlushedSingle : SinglePrecision {
  static constexpr auto kFlush = Text(".ftz");
  [[gnu::always_inline]] static float value(float x) {
    return (float_bits(x) & 0x7f80'0000u) == 0 ? 0.0f : x;
  }
};
struct DoublePrecision : Named<double, ".f64"> {
  static constexpr auto kFlush = Text("");
  static constexpr Unit kUnit = Unit::Fp64;
  static constexpr uint64_t kOne = 0x3ff0'0000'0000'0000, kTwo = 0x4000'0000'0000'0000,
                            kNan = 0x7ff8'0000'0000'0000;
  [[gnu::always_inline]] static double value(double x) { return x; }
};
struct HalfPrecision : Named<Half, ".f16"> {
  static constexpr auto kFlush = Text("");
  static constexpr Unit kUnit = Unit::Fp16;
  static constexpr uint64_t kOne = 0x3c00, kTwo = 0x4000, kNan = 0x7e00;
  // Returns a float that compares like the half in the upper bits of a word. It is the word itself, except
  // for a NaN.
  [[gnu::always_inline]] static float upper_value(uint32_t word) {
    return float_of((word & 0x7fff'0000u) > 0x7c00'0000u ? kCanonicalNan : word);
  }
  [[gnu::always_inline]] static float value(Half x) { return upper_value(uint32_t(x.bits) << 16); }
};
struct FlushedHalf : HalfPrecision {
  static constexpr auto kFlush = Text(".ftz");
  // Uses the bits as a float whose exponent is raised so far that infinities and NaNs become those of a
  // float. The order stays, and only numbers that become 0 need a choice.
  [[gnu::always_inline]] static float upper_value(uint32_t word) {
    const uint32_t magnitude = word & 0x7fff'0000u;
    const uint32_t raised =
        magnitude < 0x0400'0000u ? 0u : (magnitude >> 3) + (0x7f80'0000u - (0x7c00'0000u >> 3));
    return float_of(raised | (word & 0x8000'0000u));
  }
  [[gnu::always_inline]] static float value(Half x) { return upper_value(uint32_t(x.bits) << 16); }
};
struct BrainFloat : Named<Bfloat, ".bf16"> {
  static constexpr auto kFlush = Text("");
  static constexpr Unit kUnit = Unit::Fp16;
  static constexpr uint64_t kOne = 0x3f80, kTwo = 0x4000, kNan = 0x7fc0;
  [[gnu::always_inline]] static float upper_value(uint32_t word) { return float_of(word); }
  [[gnu::always_inline]] static float value(Bfloat x) { return to_float(x); }
};

// Calls make.operator()<R>(doc) for the fourteen relations of floats.
template <class Make>
constexpr auto for_relations(Make make) {
  return joined_rows(make.template operator()<Relation<".eq", IsEqual, 0, 1, 0>>(
                         "Gives true where a == b, and false with a NaN."),
                     make.template operator()<Relation<".ne", IsLessOrGreater, 1, 0, 1>>(
                         "Gives true where a != b, and false with a NaN."),
                     make.template operator()<Relation<".lt", IsLess, 1, 0, 0>>(
                         "Gives true where a < b, and false with a NaN."),
                     make.template operator()<Relation<".le", IsLessOrEqual, 1, 1, 0>>(
                         "Gives true where a <= b, and false with a NaN."),
                     make.template operator()<Relation<".gt", IsGreater, 0, 0, 1>>(
                         "Gives true where a > b, and false with a NaN."),
                     make.template operator()<Relation<".ge", IsGreaterOrEqual, 0, 1, 1>>(
                         "Gives true where a >= b, and false with a NaN."),
                     make.template operator()<Relation<".equ", Not<IsLessOrGreater>, 0, 1, 0, 1>>(
                         "Gives true where a == b or one source is a NaN."),
                     make.template operator()<Relation<".neu", IsNotEqual, 1, 0, 1, 1>>(
                         "Gives true where a != b or one source is a NaN."),
                     make.template operator()<Relation<".ltu", Not<IsGreaterOrEqual>, 1, 0, 0, 1>>(
                         "Gives true where a < b or one source is a NaN."),
                     make.template operator()<Relation<".leu", Not<IsGreater>, 1, 1, 0, 1>>(
                         "Gives true where a <= b or one source is a NaN."),
                     make.template operator()<Relation<".gtu", Not<IsLessOrEqual>, 0, 0, 1, 1>>(
                         "Gives true where a > b or one source is a NaN."),
                     make.template operator()<Relation<".geu", Not<IsLess>, 0, 1, 1, 1>>(
                         "Gives true where a >= b or one source is a NaN."),
                     make.template operator()<Relation<".num", IsOrdered, 1, 1, 1, 0>>(
                         "Gives true where neither source is a NaN."),
                     make.template operator()<Relation<".nan", Not<IsOrdered>, 0, 0, 0, 1>>(
                         "Gives true where one source is a NaN."));
}

constexpr OpRow with_example(OpRow row, Example example) {
  row.examples.at[row.examples.count++] = example;
  return row;
}
template <class R, class N>
constexpr auto float_relation_rows(std::string_view doc) {
  auto rows = relation_rows<R, N>(doc);
  rows[0] = with_example(rows[0], {{N::kOne, N::kNan}, R::kTruth.unordered});
  return rows;
}

// Selects half a pair of 16-bit floats like a single operand, for the two predicates of setp.lt.f16x2.
template <class N, int kShift>
struct HalfOfPair {
  using Type = uint32_t;
  [[gnu::always_inline]] static float value(uint32_t x) {
    return N::upper_value(kShift == 0 ? x << 16 : x & 0xffff'0000u);
  }
};
template <class R, class N>
void run_pair(Warp& warp, const Inst& inst) {
  const Slot* const slot = &inst.operand.front();
  write_predicate(warp, slot[0], compared<R, HalfOfPair<N, 0>>(warp, slot[2], slot[3]));
  write_predicate(warp, slot[1], compared<R, HalfOfPair<N, 16>>(warp, slot[2], slot[3]));
}
template <class R, class N, class Op>
void run_pair_combined(Warp& warp, const Inst& inst) {
  const Slot* const slot = &inst.operand.front();
  const LaneMask other = *(&warp.predicate.front() + slot[4]);  // read before it may be written
  write_predicate(warp, slot[0], Op::apply(compared<R, HalfOfPair<N, 0>>(warp, slot[2], slot[3]), other));
  write_predicate(warp, slot[1], Op::apply(compared<R, HalfOfPair<N, 16>>(warp, slot[2], slot[3]), other));
}
template <class R, class N, uint32_t kYes>
[[gnu::flatten]] void run_pair_set(Warp& warp, const Inst& inst) {
  const Slot* const slot = &inst.operand.front();
  const LaneMask low = compared<R, HalfOfPair<N, 0>>(warp, slot[1], slot[2]);
  const LaneMask high = compared<R, HalfOfPair<N, 16>>(warp, slot[1], slot[2]);
  write_lanes<uint32_t>(warp, slot[0], [&](int i) {
    return ((low & kLaneBit[i]) != 0 ? kYes : 0u) | ((high & kLaneBit[i]) != 0 ? kYes << 16 : 0u);
  });
}

// Compares (1, 1) with (2, 1), low half first: less, then equal.
template <class N>
inline constexpr uint64_t kOnes = N::kOne | N::kOne << 16;
template <class N>
inline constexpr uint64_t kTwoOne = N::kTwo | N::kOne << 16;

template <class R, class N, class Op>
constexpr OpRow combined_pair_row() {
  constexpr auto example = [](bool c) {
    return Example{{kOnes<N>, kTwoOne<N>, c}, Op::apply(R::kTruth.less, c), Op::apply(R::kTruth.equal, c)};
  };
  return comparison_row(joined<"setp", R::kName, Op::kName, N::kFlush, N::kName, "x2">, Unit::Fp16,
                        {DstPred, DstPred, Src32, Src32, SrcPred}, &run_pair_combined<R, N, Op>,
                        "Compares the low and the high halves, and combines each result with a predicate.",
                        {example(false), example(true)});
}
template <class R, class N, uint32_t kYes>
constexpr auto pair_rows() {
  constexpr Truth kTruth = R::kTruth;
  constexpr uint64_t kSet = (kTruth.less ? kYes : 0u) | (kTruth.equal ? kYes << 16 : 0u);
  return joined_rows(
      comparison_row(joined<"setp", R::kName, N::kFlush, N::kName, "x2">, Unit::Fp16,
                     {DstPred, DstPred, Src32, Src32}, &run_pair<R, N>,
                     "Compares the low and the high halves, and gives two predicates.",
                     {{{kOnes<N>, kTwoOne<N>}, kTruth.less, kTruth.equal},
                      {{kTwoOne<N>, kOnes<N>}, kTruth.greater, kTruth.equal}}),
      combined_pair_row<R, N, And>(), combined_pair_row<R, N, Or>(), combined_pair_row<R, N, Xor>(),
      comparison_row(
          joined<"set", R::kName, N::kFlush, N::kName, "x2", N::kName, "x2">, Unit::Fp16,
          {Dst32, Src32, Src32}, &run_pair_set<R, N, kYes>,
          "Compares the low and the high halves, and gives two floats: 1 for true, 0 for false.",
          {{{kOnes<N>, kTwoOne<N>}, kSet}, {{kOnes<N>, kOnes<N>}, kTruth.equal ? kYes * 0x1'0001u : 0}}));
}
// Gives a result of 16 bits: all ones, or 1 as a float of the source's type.
template <class R, class N, uint32_t kYes>
constexpr auto short_set_rows() {
  return joined_rows(set_row<R, N, ".u16", 0xffffu>(), set_row<R, N, ".s16", 0xffffu>(),
                     set_row<R, N, N::kName, kYes>());
}

constexpr auto kSingleRows =
    for_relations([]<class R>(std::string_view doc) { return float_relation_rows<R, SinglePrecision>(doc); });
constexpr auto kFlushedRows =
    for_relations([]<class R>(std::string_view doc) { return float_relation_rows<R, FlushedSingle>(doc); });
constexpr auto kDoubleRows =
    for_relations([]<class R>(std::string_view doc) { return float_relation_rows<R, DoublePrecision>(doc); });
template <class N, uint32_t kYes>
constexpr auto short_rows() {
  return for_relations([]<class R>(std::string_view doc) {
    return joined_rows(float_relation_rows<R, N>(doc), short_set_rows<R, N, kYes>(), pair_rows<R, N, kYes>());
  });
}
constexpr auto kHalfRows = short_rows<HalfPrecision, 0x3c00>();
constexpr auto kFlushedHalfRows = short_rows<FlushedHalf, 0x3c00>();
constexpr auto kBfloatRows = short_rows<BrainFloat, 0x3f80>();

constexpr auto kRows =
    joined_rows(kSingleRows, kFlushedRows, kDoubleRows, kHalfRows, kFlushedHalfRows, kBfloatRows);

}  // namespace

RowList compare_float_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
