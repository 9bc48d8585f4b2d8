// Builds comparison rows: the relations, and the handlers of setp and set, which share one loop over the
// lanes.
// SPDX-License-Identifier: Apache-2.0
//
// Only files of isa/ops include this file. Everything is in an unnamed namespace, so each file has its own
// handlers.
#pragma once
#include <array>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <type_traits>

#include "isa/ops/row_tables.h"
#include "isa/ops/word.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Names the tests for which there is code. Every relation is one of them or its opposite. A test of floats is
// false with a NaN.
enum class Test : uint8_t {
  Equal,
  Less,
  Greater,
  LessOrEqual,
  GreaterOrEqual,
  LessOrGreater,
  Ordered,
  Count
};
template <Test kTest, class T>
[[gnu::always_inline]] inline bool holds(T a, T b) {
  if constexpr (kTest == Test::Equal) {
    // Compilers leave == of single precision in scalar code on the widest path.
    if constexpr (std::is_same_v<T, float>) return bool((a <= b) & (a >= b));
    return a == b;
  }
  if constexpr (kTest == Test::Less) return a < b;
  if constexpr (kTest == Test::Greater) return a > b;
  if constexpr (kTest == Test::LessOrEqual) return a <= b;
  if constexpr (kTest == Test::GreaterOrEqual) return a >= b;
  if constexpr (kTest == Test::LessOrGreater) return bool((a < b) | (a > b));
  if constexpr (kTest == Test::Ordered) return bool((a <= b) | (a > b));
}

// Returns the mask of the lanes where a test holds between two sources. N::Type is the type of a lane, and
// N::value returns the part of it that is compared.
template <Test kTest, class N>
[[gnu::flatten, gnu::noinline]] LaneMask compared(const Warp& warp, Slot a, Slot b) {
  const Source<typename N::Type> x(warp, a), y(warp, b);
  return mask_of([&](int i) { return holds<kTest>(N::value(x.at(i)), N::value(y.at(i))); });
}
// Does so for a relation, which is the test or its opposite.
template <Test kTest, bool kOpposite, class N>
[[gnu::always_inline]] inline LaneMask related(const Warp& warp, Slot a, Slot b) {
  const LaneMask mask = compared<kTest, N>(warp, a, b);
  return kOpposite ? ~mask : mask;
}

template <Test kTest, bool kOpposite, class N>
void run_setp(Warp& warp, const Inst& inst, const OpRow&) {
  const Slot* const slot = &inst.operand.front();
  write_predicate(warp, slot[0], related<kTest, kOpposite, N>(warp, slot[1], slot[2]));
}

// Describes a combining operator of setp, %p0 = r op c, %p1 = !r op c: whether it is true where both r and c
// are, and where one of them is.
struct Combination {
  std::string_view name;
  LaneMask for_both, for_one;
  [[gnu::always_inline]] constexpr LaneMask of(LaneMask r, LaneMask c) const {
    return (r & c & for_both) | ((r ^ c) & for_one);
  }
};
constexpr Combination kCombinations[] = {
    {".and", kAllLanes, 0}, {".or", kAllLanes, kAllLanes}, {".xor", 0, kAllLanes}};
template <Test kTest, bool kOpposite, class N, size_t kCombination>
void run_setp_combined(Warp& warp, const Inst& inst, const OpRow&) {
  const Slot* const slot = &inst.operand.front();
  const LaneMask result = related<kTest, kOpposite, N>(warp, slot[2], slot[3]);
  const LaneMask other = *(&warp.predicate.front() + slot[4]);
  write_predicate(warp, slot[0], kCombinations[kCombination].of(result, other));
  write_predicate(warp, slot[1], kCombinations[kCombination].of(~result, other));
}

// Lists the numbers that set gives for true. The detail of a row is an index.
constexpr uint32_t kYes[] = {0xffff'ffff, 0x3f80'0000, 0xffff, 0x3c00, 0x3f80};
[[gnu::flatten, gnu::noinline]] void write_choice(Warp& warp, Slot slot, LaneMask mask, uint32_t yes) {
  write_lanes<uint32_t>(warp, slot, [&](int i) { return (mask & kLaneBit[i]) != 0 ? yes : 0u; });
}
// Writes a number where the relation holds, and 0 elsewhere.
template <Test kTest, bool kOpposite, class N>
void run_set(Warp& warp, const Inst& inst, const OpRow& row) {
  const Slot* const slot = &inst.operand.front();
  const LaneMask result = related<kTest, kOpposite, N>(warp, slot[1], slot[2]);
  write_choice(warp, slot[0], result, kYes[row.detail]);
}

// Holds the handlers of one relation of one type.
struct Handlers {
  using OfCombinations = std::array<Handler, std::size(kCombinations)>;
  Handler setp = nullptr, set = nullptr;
  OfCombinations combined{};
  // These are of pairs of 16-bit floats.
  Handler setp_pair = nullptr, set_pair = nullptr;
  OfCombinations combined_pair{};
};
template <class N, Test kTest, bool kOpposite>
constexpr Handlers handlers() {
  return {&run_setp<kTest, kOpposite, N>,
          &run_set<kTest, kOpposite, N>,
          {&run_setp_combined<kTest, kOpposite, N, 0>, &run_setp_combined<kTest, kOpposite, N, 1>,
           &run_setp_combined<kTest, kOpposite, N, 2>}};
}
// Holds the handlers of all tests, and of their opposites.
using HandlersOfTests = std::array<std::array<Handlers, 2>, size_t(Test::Count)>;
template <class N, Test... kTest>
constexpr void add_handlers(HandlersOfTests& out) {
  ((out[size_t(kTest)] = {handlers<N, kTest, false>(), handlers<N, kTest, true>()}), ...);
}

// Describes a relation as PTX names it: the test, whether the relation is the test's opposite, and its
// results for a < b, a == b, a > b, and a or b not a number. The examples are made from them.
struct Relation {
  std::string_view name, doc;
  Test test;
  bool is_opposite;
  bool less, equal, greater, unordered = false;
};

// Describes the type of the sources. Examples compare `one`, `two` and (of floats) `nan`.
struct Compared {
  std::string_view flush, name;
  Unit unit;
  OperandKind source;
  uint64_t one, two, nan;
  HandlersOfTests handlers;
};

constexpr OpRow comparison_row(std::string_view name, const Compared& type, size_t detail, Operands operands,
                               Handler run, std::string_view doc, Examples examples) {
  OpRow row;
  row.name = name;
  row.unit = type.unit;
  row.operands = operands;
  row.detail = uint16_t(detail);
  row.run = run;
  row.doc = doc;
  row.examples = examples;
  return row;
}

// Names a type of the result of set, and the number for true.
struct Result {
  std::string_view name;
  uint8_t yes;
};
constexpr Result kResults[] = {{".u32", 0}, {".s32", 0}, {".f32", 1}};
inline constexpr size_t kRowsOfRelation = 1 + std::size(kCombinations) + std::size(kResults);

constexpr const Handlers& handlers_of(const Compared& type, const Relation& r) {
  return type.handlers[size_t(r.test)][r.is_opposite];
}
constexpr OpRow setp_row(std::string_view name, const Compared& type, const Relation& r) {
  Examples examples{
      {{type.one, type.one}, r.equal}, {{type.one, type.two}, r.less}, {{type.two, type.one}, r.greater}};
  if (type.nan != 0) examples.at[examples.count++] = {{type.one, type.nan}, r.unordered};
  return comparison_row(name, type, 0, {DstPred, type.source, type.source}, handlers_of(type, r).setp, r.doc,
                        examples);
}
constexpr OpRow combined_row(std::string_view name, const Compared& type, const Relation& r,
                             size_t combination) {
  const Combination& op = kCombinations[combination];
  const auto example = [&](uint64_t b, bool result, bool c) {
    return Example{{type.one, b, c}, op.of(result, c), op.of(!result, c)};
  };
  return comparison_row(
      name, type, 0, {DstPred, DstPred, type.source, type.source, SrcPred},
      handlers_of(type, r).combined[combination],
      "Combines the comparison with a predicate, and the opposite comparison with the same predicate.",
      {example(type.two, r.less, false), example(type.two, r.less, true), example(type.one, r.equal, false),
       example(type.one, r.equal, true)});
}
constexpr OpRow set_row(std::string_view name, const Compared& type, const Relation& r,
                        const Result& result) {
  const uint32_t yes = kYes[result.yes];
  return comparison_row(
      name, type, result.yes, {Dst32, type.source, type.source}, handlers_of(type, r).set,
      "Compares as setp does, but gives a value: 0 for false, and all ones or the float 1 for true.",
      {{{type.one, type.one}, r.equal ? yes : 0}, {{type.one, type.two}, r.less ? yes : 0}});
}

using NameParts = std::initializer_list<std::string_view>;
// Calls visit(parts of a name, make) for the rows of one relation and type, where make(name) gives the row.
template <class Visit>
constexpr void each_row(const Compared& type, const Relation& r, Visit&& visit) {
  visit(NameParts{"setp", r.name, type.flush, type.name}, [&](auto name) { return setp_row(name, type, r); });
  for (size_t c = 0; c < std::size(kCombinations); ++c)
    visit(NameParts{"setp", r.name, kCombinations[c].name, type.flush, type.name},
          [&](auto name) { return combined_row(name, type, r, c); });
  for (const Result& result : kResults)
    visit(NameParts{"set", r.name, type.flush, result.name, type.name},
          [&](auto name) { return set_row(name, type, r, result); });
}

// Build the names and the rows of a file. each(visit) calls visit(parts of a name, make) for all its rows.
template <size_t kNumRows, class Each>
constexpr std::array<Word, kNumRows> names_of(Each&& each) {
  std::array<Word, kNumRows> out{};
  size_t n = 0;
  each([&](NameParts name, auto&&) { out[n++] = Word(name); });
  return out;
}
template <size_t kNumRows, class Each>
constexpr std::array<OpRow, kNumRows> rows_of(const std::array<Word, kNumRows>& names, Each&& each) {
  std::array<OpRow, kNumRows> out{};
  size_t n = 0;
  each([&](NameParts, auto&& make) { out[n] = make(names[n].view()), ++n; });
  return out;
}

}  // namespace
}  // namespace glint::isa::GLINT_ISA_PATH
