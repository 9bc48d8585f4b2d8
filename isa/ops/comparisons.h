// Builds comparison rows: the relations, and the handlers of setp and set, which share one loop over the
// lanes.
// SPDX-License-Identifier: Apache-2.0
//
// Only files of isa/ops include this file. Everything is in an unnamed namespace, so each file has its own
// handlers.
#pragma once
#include <cstdint>
#include <string_view>

#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Holds the results for a < b, a == b, a > b, and a or b not a number. The examples of a relation are made
// from them.
struct Truth {
  bool less, equal, greater, unordered;
};

// Names a relation as PTX does. Test computes it.
template <Text kText, class Test, bool kLess, bool kEqual, bool kGreater, bool kUnordered = false>
struct Relation {
  static constexpr auto kName = kText;
  static constexpr Truth kTruth{kLess, kEqual, kGreater, kUnordered};
  template <class T>
  [[gnu::always_inline]] static bool holds(T a, T b) {
    return Test{}(a, b);
  }
};

struct IsEqual {
  bool operator()(auto a, auto b) const { return a == b; }
  // Compilers leave == of single precision in scalar code on the widest path.
  bool operator()(float a, float b) const { return bool((a <= b) & (a >= b)); }
};
struct IsNotEqual {
  bool operator()(auto a, auto b) const { return a != b; }
};
struct IsLess {
  bool operator()(auto a, auto b) const { return a < b; }
};
struct IsLessOrEqual {
  bool operator()(auto a, auto b) const { return a <= b; }
};
struct IsGreater {
  bool operator()(auto a, auto b) const { return a > b; }
};
struct IsGreaterOrEqual {
  bool operator()(auto a, auto b) const { return a >= b; }
};

// Returns the mask of the lanes where the relation holds between two sources. N::Type is the type of a lane,
// and N::value returns the part of it that is compared.
template <class R, class N>
[[gnu::flatten, gnu::noinline]] LaneMask compared(const Warp& warp, Slot a, Slot b) {
  const Source<typename N::Type> x(warp, a), y(warp, b);
  return mask_of([&](int i) { return R::holds(N::value(x.at(i)), N::value(y.at(i))); });
}

template <class R, class N>
void run_setp(Warp& warp, const Inst& inst) {
  const Slot* const slot = &inst.operand.front();
  write_predicate(warp, slot[0], compared<R, N>(warp, slot[1], slot[2]));
}

// These are the combining operators of setp: %p0 = r op c, %p1 = !r op c.
struct And {
  static constexpr auto kName = Text(".and");
  static constexpr bool apply(bool r, bool c) { return r && c; }
  static constexpr LaneMask apply(LaneMask r, LaneMask c) { return r & c; }
};
struct Or {
  static constexpr auto kName = Text(".or");
  static constexpr bool apply(bool r, bool c) { return r || c; }
  static constexpr LaneMask apply(LaneMask r, LaneMask c) { return r | c; }
};
struct Xor {
  static constexpr auto kName = Text(".xor");
  static constexpr bool apply(bool r, bool c) { return r != c; }
  static constexpr LaneMask apply(LaneMask r, LaneMask c) { return r ^ c; }
};
template <class R, class N, class Op>
void run_setp_combined(Warp& warp, const Inst& inst) {
  const Slot* const slot = &inst.operand.front();
  const LaneMask result = compared<R, N>(warp, slot[2], slot[3]);
  const LaneMask other = *(&warp.predicate.front() + slot[4]);
  write_predicate(warp, slot[0], Op::apply(result, other));
  write_predicate(warp, slot[1], Op::apply(~result, other));
}

[[gnu::flatten, gnu::noinline]] void write_choice(Warp& warp, Slot slot, LaneMask mask, uint32_t yes) {
  write_lanes<uint32_t>(warp, slot, [&](int i) { return (mask & kLaneBit[i]) != 0 ? yes : 0u; });
}
// Writes `yes` where the relation holds, and 0 elsewhere.
template <class R, class N, uint32_t kYes>
void run_set(Warp& warp, const Inst& inst) {
  const Slot* const slot = &inst.operand.front();
  write_choice(warp, slot[0], compared<R, N>(warp, slot[1], slot[2]), kYes);
}

constexpr OpRow comparison_row(std::string_view name, Unit unit, Operands operands, Handler run,
                               std::string_view doc, Examples examples) {
  OpRow row;
  row.name = name;
  row.unit = unit;
  row.operands = operands;
  row.run = run;
  row.doc = doc;
  row.examples = examples;
  return row;
}

// N has kFlush (".ftz" or ""), kName (".f32"), kOne and kTwo as examples write them, and kUnit.
template <class R, class N>
constexpr OpRow setp_row(std::string_view doc) {
  constexpr OperandKind kKind = source_kind<typename N::Type>();
  constexpr Truth kTruth = R::kTruth;
  return comparison_row(joined<"setp", R::kName, N::kFlush, N::kName>, N::kUnit, {DstPred, kKind, kKind},
                        &run_setp<R, N>, doc,
                        {{{N::kOne, N::kOne}, kTruth.equal},
                         {{N::kOne, N::kTwo}, kTruth.less},
                         {{N::kTwo, N::kOne}, kTruth.greater}});
}
template <class R, class N, class Op>
constexpr OpRow combined_row() {
  constexpr OperandKind kKind = source_kind<typename N::Type>();
  constexpr Truth kTruth = R::kTruth;
  constexpr auto example = [](uint64_t b, bool r, bool c) {
    return Example{{N::kOne, b, c}, Op::apply(r, c), Op::apply(!r, c)};
  };
  return comparison_row(
      joined<"setp", R::kName, Op::kName, N::kFlush, N::kName>, N::kUnit,
      {DstPred, DstPred, kKind, kKind, SrcPred}, &run_setp_combined<R, N, Op>,
      "Combines the comparison with a predicate, and the opposite comparison with the same predicate.",
      {example(N::kTwo, kTruth.less, false), example(N::kTwo, kTruth.less, true),
       example(N::kOne, kTruth.equal, false), example(N::kOne, kTruth.equal, true)});
}
template <class R, class N, Text kType, uint32_t kYes>
constexpr OpRow set_row() {
  constexpr OperandKind kKind = source_kind<typename N::Type>();
  constexpr Truth kTruth = R::kTruth;
  return comparison_row(
      joined<"set", R::kName, N::kFlush, kType, N::kName>, N::kUnit, {Dst32, kKind, kKind},
      &run_set<R, N, kYes>,
      "Compares as setp does, but gives a value: 0 for false, and all ones or the float 1 for true.",
      {{{N::kOne, N::kOne}, kTruth.equal ? kYes : 0}, {{N::kOne, N::kTwo}, kTruth.less ? kYes : 0}});
}

// Makes the rows of one relation and type: setp, combined setp, and set.
template <class R, class N>
constexpr auto relation_rows(std::string_view doc) {
  return joined_rows(setp_row<R, N>(doc), combined_row<R, N, And>(), combined_row<R, N, Or>(),
                     combined_row<R, N, Xor>(), set_row<R, N, ".u32", 0xffff'ffffu>(),
                     set_row<R, N, ".s32", 0xffff'ffffu>(), set_row<R, N, ".f32", 0x3f80'0000u>());
}

}  // namespace
}  // namespace glint::isa::GLINT_ISA_PATH
