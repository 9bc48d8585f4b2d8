// Defines comparisons of floats. A comparison with a NaN is false, except for relations that end in u.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "isa/half.h"
#include "isa/ops/comparisons.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

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

constexpr Relation kRelations[] = {
    {".eq", "Gives true where a == b, and false with a NaN.", Test::Equal, false, 0, 1, 0},
    {".ne", "Gives true where a != b, and false with a NaN.", Test::LessOrGreater, false, 1, 0, 1},
    {".lt", "Gives true where a < b, and false with a NaN.", Test::Less, false, 1, 0, 0},
    {".le", "Gives true where a <= b, and false with a NaN.", Test::LessOrEqual, false, 1, 1, 0},
    {".gt", "Gives true where a > b, and false with a NaN.", Test::Greater, false, 0, 0, 1},
    {".ge", "Gives true where a >= b, and false with a NaN.", Test::GreaterOrEqual, false, 0, 1, 1},
    {".equ", "Gives true where a == b or one source is a NaN.", Test::LessOrGreater, true, 0, 1, 0, 1},
    {".neu", "Gives true where a != b or one source is a NaN.", Test::Equal, true, 1, 0, 1, 1},
    {".ltu", "Gives true where a < b or one source is a NaN.", Test::GreaterOrEqual, true, 1, 0, 0, 1},
    {".leu", "Gives true where a <= b or one source is a NaN.", Test::Greater, true, 1, 1, 0, 1},
    {".gtu", "Gives true where a > b or one source is a NaN.", Test::LessOrEqual, true, 0, 0, 1, 1},
    {".geu", "Gives true where a >= b or one source is a NaN.", Test::Less, true, 0, 1, 1, 1},
    {".num", "Gives true where neither source is a NaN.", Test::Ordered, false, 1, 1, 1, 0},
    {".nan", "Gives true where one source is a NaN.", Test::Ordered, true, 0, 0, 0, 1},
};

// Selects half a pair of 16-bit floats like a single operand, for the two predicates of setp.lt.f16x2.
template <class N, int kShift>
struct HalfOfPair {
  using Type = uint32_t;
  [[gnu::always_inline]] static float value(uint32_t x) {
    return N::upper_value(kShift == 0 ? x << 16 : x & 0xffff'0000u);
  }
};
template <Test kTest, bool kOpposite, class N>
void run_pair(Warp& warp, const Inst& inst, const OpRow&) {
  const Slot* const slot = &inst.operand.front();
  write_predicate(warp, slot[0], related<kTest, kOpposite, HalfOfPair<N, 0>>(warp, slot[2], slot[3]));
  write_predicate(warp, slot[1], related<kTest, kOpposite, HalfOfPair<N, 16>>(warp, slot[2], slot[3]));
}
template <Test kTest, bool kOpposite, class N, size_t kCombination>
void run_pair_combined(Warp& warp, const Inst& inst, const OpRow&) {
  const Slot* const slot = &inst.operand.front();
  const LaneMask other = *(&warp.predicate.front() + slot[4]);  // read before it may be written
  const LaneMask low = related<kTest, kOpposite, HalfOfPair<N, 0>>(warp, slot[2], slot[3]);
  const LaneMask high = related<kTest, kOpposite, HalfOfPair<N, 16>>(warp, slot[2], slot[3]);
  write_predicate(warp, slot[0], kCombinations[kCombination].of(low, other));
  write_predicate(warp, slot[1], kCombinations[kCombination].of(high, other));
}
[[gnu::flatten, gnu::noinline]] void write_choices(Warp& warp, Slot slot, LaneMask low, LaneMask high,
                                                   uint32_t yes) {
  write_lanes<uint32_t>(warp, slot, [&](int i) {
    return ((low & kLaneBit[i]) != 0 ? yes : 0u) | ((high & kLaneBit[i]) != 0 ? yes << 16 : 0u);
  });
}
template <Test kTest, bool kOpposite, class N>
void run_pair_set(Warp& warp, const Inst& inst, const OpRow& row) {
  const Slot* const slot = &inst.operand.front();
  const LaneMask low = related<kTest, kOpposite, HalfOfPair<N, 0>>(warp, slot[1], slot[2]);
  const LaneMask high = related<kTest, kOpposite, HalfOfPair<N, 16>>(warp, slot[1], slot[2]);
  write_choices(warp, slot[0], low, high, kYes[row.detail]);
}

// Describes a type. 16-bit floats have pairs, and `yes` is the 1 of their type: an index of kYes.
struct FloatType {
  Compared type;
  bool has_pairs;
  uint8_t yes;
};
template <class N, Test kTest, bool kOpposite>
constexpr void add_pair_handlers(Handlers& of) {
  of.setp_pair = &run_pair<kTest, kOpposite, N>;
  of.combined_pair = {&run_pair_combined<kTest, kOpposite, N, 0>, &run_pair_combined<kTest, kOpposite, N, 1>,
                      &run_pair_combined<kTest, kOpposite, N, 2>};
  of.set_pair = &run_pair_set<kTest, kOpposite, N>;
}
template <class N, bool kHasPairs, Test... kTest>
constexpr HandlersOfTests handlers_of_tests() {
  HandlersOfTests out;
  add_handlers<N, kTest...>(out);
  if constexpr (kHasPairs) {
    (add_pair_handlers<N, kTest, false>(out[size_t(kTest)][0]), ...);
    (add_pair_handlers<N, kTest, true>(out[size_t(kTest)][1]), ...);
  }
  return out;
}
template <class N>
constexpr FloatType float_type(uint8_t yes) {
  constexpr bool kHasPairs = sizeof(typename N::Type) == 2;
  return {{joined<N::kFlush>, joined<N::kName>, N::kUnit, source_kind<typename N::Type>(), N::kOne, N::kTwo,
           N::kNan,
           handlers_of_tests<N, kHasPairs, Test::Equal, Test::Less, Test::Greater, Test::LessOrEqual,
                             Test::GreaterOrEqual, Test::LessOrGreater, Test::Ordered>()},
          kHasPairs,
          yes};
}
constexpr FloatType kTypes[] = {
    float_type<SinglePrecision>(0), float_type<FlushedSingle>(0), float_type<DoublePrecision>(0),
    float_type<HalfPrecision>(3),   float_type<FlushedHalf>(3),   float_type<BrainFloat>(4),
};

// Examples compare (1, 1) with (2, 1), low half first: less, then equal.
constexpr uint64_t ones(const Compared& type) {
  return type.one | type.one << 16;
}
constexpr uint64_t two_one(const Compared& type) {
  return type.two | type.one << 16;
}
constexpr OpRow pair_row(std::string_view name, const Compared& type, const Relation& r) {
  return comparison_row(
      name, type, 0, {DstPred, DstPred, Src32, Src32}, handlers_of(type, r).setp_pair,
      "Compares the low and the high halves, and gives two predicates.",
      {{{ones(type), two_one(type)}, r.less, r.equal}, {{two_one(type), ones(type)}, r.greater, r.equal}});
}
constexpr OpRow combined_pair_row(std::string_view name, const Compared& type, const Relation& r,
                                  size_t combination) {
  const Combination& op = kCombinations[combination];
  const auto example = [&](bool c) {
    return Example{{ones(type), two_one(type), c}, op.of(r.less, c), op.of(r.equal, c)};
  };
  return comparison_row(name, type, 0, {DstPred, DstPred, Src32, Src32, SrcPred},
                        handlers_of(type, r).combined_pair[combination],
                        "Compares the low and the high halves, and combines each result with a predicate.",
                        {example(false), example(true)});
}
constexpr OpRow pair_set_row(std::string_view name, const Compared& type, const Relation& r, uint8_t yes) {
  const uint32_t one = kYes[yes], less_equal = (r.less ? one : 0u) | (r.equal ? one << 16 : 0u);
  return comparison_row(
      name, type, yes, {Dst32, Src32, Src32}, handlers_of(type, r).set_pair,
      "Compares the low and the high halves, and gives two floats: 1 for true, 0 for false.",
      {{{ones(type), two_one(type)}, less_equal}, {{ones(type), ones(type)}, r.equal ? one * 0x1'0001u : 0}});
}

// Does the same as each_row() for the rows that only 16-bit floats have: results of 16 bits, and pairs.
template <class Visit>
constexpr void each_short_row(const FloatType& of, const Relation& r, Visit&& visit) {
  const Compared& type = of.type;
  for (const Result& result : {Result{".u16", 2}, Result{".s16", 2}, Result{type.name, of.yes}})
    visit(NameParts{"set", r.name, type.flush, result.name, type.name},
          [&](auto name) { return set_row(name, type, r, result); });
  visit(NameParts{"setp", r.name, type.flush, type.name, "x2"},
        [&](auto name) { return pair_row(name, type, r); });
  for (size_t c = 0; c < std::size(kCombinations); ++c)
    visit(NameParts{"setp", r.name, kCombinations[c].name, type.flush, type.name, "x2"},
          [&](auto name) { return combined_pair_row(name, type, r, c); });
  visit(NameParts{"set", r.name, type.flush, type.name, "x2", type.name, "x2"},
        [&](auto name) { return pair_set_row(name, type, r, of.yes); });
}
template <class Visit>
constexpr void each_row(Visit&& visit) {
  for (const FloatType& of : kTypes)
    for (const Relation& r : kRelations) {
      each_row(of.type, r, visit);
      if (of.has_pairs) each_short_row(of, r, visit);
    }
}
constexpr size_t kNumRows = [] {
  size_t n = 0;
  for (const FloatType& of : kTypes)
    n += kRowsOfRelation + (of.has_pairs ? 3 + 2 + std::size(kCombinations) : 0);
  return n * std::size(kRelations);
}();
constexpr auto kEachRow = [](auto&& visit) { each_row(visit); };
constexpr auto kNames = names_of<kNumRows>(kEachRow);
constexpr auto kRows = rows_of(kNames, kEachRow);

}  // namespace

RowList compare_float_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
