// Makes op rows: wraps the work of one lane into a handler for the whole warp.
// SPDX-License-Identifier: Apache-2.0
//
// Only files of isa/ops include this file. They are compiled once for each SIMD path. Everything here is in a
// namespace of its path, and rows pass lambdas of an unnamed namespace, so no path can link another path's
// code.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "isa/kernels.h"
#include "isa/op_row.h"

namespace glint::isa::GLINT_ISA_PATH {

using enum OperandKind;

// Entry i has bit i set, which is the mask bit of lane i. As data, masks can be tested a vector at a time.
inline constexpr LaneMask kLaneBit[kLanes] = {
    1u << 0,  1u << 1,  1u << 2,  1u << 3,  1u << 4,  1u << 5,  1u << 6,  1u << 7,
    1u << 8,  1u << 9,  1u << 10, 1u << 11, 1u << 12, 1u << 13, 1u << 14, 1u << 15,
    1u << 16, 1u << 17, 1u << 18, 1u << 19, 1u << 20, 1u << 21, 1u << 22, 1u << 23,
    1u << 24, 1u << 25, 1u << 26, 1u << 27, 1u << 28, 1u << 29, 1u << 30, 1u << 31};

// Calls `lane(i)` for all lanes. Rows are equal or disjoint, and a lane touches only its own column, so no
// lane depends on another. The compiler cannot know this and is told so.
template <class Lane>
[[gnu::always_inline]] inline void all_lanes(Lane&& lane) {
#if defined(__clang__)
#pragma clang loop vectorize(assume_safety)
#else
#pragma GCC ivdep
#endif
  for (int i = 0; i < kLanes; ++i) lane(i);
}

// Holds floats of 16 bits, and pairs of them, as bits only. Their arithmetic is in isa/half.h.
struct Half {
  uint16_t bits;
};
struct Bfloat {
  uint16_t bits;
};
template <class T>
struct Pair {
  T low, high;
};

// Holds the results of an op with two destinations, written `%r1|%p2`. B is bool.
template <class A, class B>
struct Two {
  A first;
  B second;
};

// Joins a name at compile time: joined<"add", ".rz", ".f32"> is the string_view "add.rz.f32".
template <size_t kSize>
struct Text {
  char at[kSize]{};
  constexpr Text(const char (&text)[kSize]) {  // NOLINT: implicit, so that literals are template arguments
    for (size_t i = 0; i < kSize; ++i) at[i] = text[i];
  }
  static constexpr size_t kLength = kSize - 1;
};
template <Text... kParts>
struct Joined {
  static constexpr size_t kLength = (kParts.kLength + ... + 0);
  static constexpr std::array<char, kLength + 1> kText = [] {
    std::array<char, kLength + 1> out{};
    size_t n = 0;
    const auto append = [&](const auto& part) {
      for (size_t i = 0; i < part.kLength; ++i) out[n++] = part.at[i];
    };
    (append(kParts), ...);
    return out;
  }();
  // Holds the joined name as a template argument of further names.
  static constexpr Text<kLength + 1> kAsText = [] {
    char out[kLength + 1]{};
    for (size_t i = 0; i < kLength; ++i) out[i] = kText[i];
    return Text<kLength + 1>(out);
  }();
};
template <Text... kParts>
inline constexpr std::string_view joined{Joined<kParts...>::kText.data(), Joined<kParts...>::kLength};

// Gives a handler a source operand of type T: it reads the bits of one lane. A 64-bit operand is two rows,
// low half first. A 16-bit operand (integer, Half, Bfloat) is the low half of a row, whose upper half means
// nothing.
template <class T>
struct Source {
  const uint32_t* low;
  const uint32_t* high;
  [[gnu::always_inline]] Source(const Warp& warp, Slot slot)
      : low(warp.bank[slot >> kBankShift] + (slot & kSlotIndexMask) * kLanes), high(low + kLanes) {}
  [[gnu::always_inline]] T at(int i) const {
    if constexpr (sizeof(T) == 8)
      return __builtin_bit_cast(T, uint64_t(low[i]) | uint64_t(high[i]) << 32);
    else if constexpr (sizeof(T) == 2)
      return __builtin_bit_cast(T, uint16_t(low[i]));
    else
      return __builtin_bit_cast(T, low[i]);
  }
};

// Gives a handler a predicate operand: it reads the bit of one lane.
template <>
struct Source<bool> {
  LaneMask mask;
  [[gnu::always_inline]] Source(const Warp& warp, Slot slot) : mask(*(&warp.predicate.front() + slot)) {}
  [[gnu::always_inline]] bool at(int i) const { return (mask & kLaneBit[i]) != 0; }
};

// Returns the bits of a result as they fill a register or pair. A 16-bit result leaves the upper half 0.
template <class T>
[[gnu::always_inline]] inline auto bits_of(T x) {
  if constexpr (sizeof(T) == 8)
    return __builtin_bit_cast(uint64_t, x);
  else if constexpr (sizeof(T) == 2)
    return uint32_t(__builtin_bit_cast(uint16_t, x));
  else
    return __builtin_bit_cast(uint32_t, x);
}

// Writes value(i) of every lane; R says how wide a result row is.
template <class R, class Value>
[[gnu::always_inline]] inline void write_all_lanes(Warp& warp, Slot slot, Value&& value) {
  uint32_t* const low = warp.bank[0] + slot * kLanes;
  if constexpr (sizeof(R) == 8) {
    uint32_t* const high = low + kLanes;
    all_lanes([&](int i) {
      const uint64_t x = bits_of(value(i));
      low[i] = uint32_t(x);
      high[i] = uint32_t(x >> 32);
    });
  } else {
    all_lanes([&](int i) { low[i] = bits_of(value(i)); });
  }
}

// Writes value(i) of the lanes of `exec`.
template <class R, class Value>
[[gnu::always_inline]] inline void write_lanes(Warp& warp, Slot slot, Value&& value) {
  const LaneMask exec = warp.exec;
  if (exec == kAllLanes) [[likely]]
    return write_all_lanes<R>(warp, slot, value);
  uint32_t* const low = warp.bank[0] + slot * kLanes;
  all_lanes([&](int i) {
    const auto x = bits_of(value(i));
    const bool write = (exec & kLaneBit[i]) != 0;
    low[i] = write ? uint32_t(x) : low[i];
    if constexpr (sizeof(R) == 8) low[kLanes + i] = write ? uint32_t(x >> 32) : low[kLanes + i];
  });
}

// Writes a predicate: the lanes of `exec` take their bit of `mask`.
[[gnu::always_inline]] inline void write_predicate(Warp& warp, Slot slot, LaneMask mask) {
  LaneMask& out = *(&warp.predicate.front() + slot);
  out = (out & ~warp.exec) | (mask & warp.exec);
}

// Returns the mask of the lanes where `test(i)` is true.
template <class Test>
[[gnu::always_inline]] inline LaneMask mask_of(Test&& test) {
#if defined(__AVX512F__)
  // The bits are loaded into registers before the test, hidden from the compiler, which would otherwise load
  // them under the test's mask. Such a masked load without lanes, from a page that nobody has touched yet,
  // faults silently and takes 300 ns each time.
  __m512i low = _mm512_loadu_si512(kLaneBit), high = _mm512_loadu_si512(kLaneBit + 16);
  asm("" : "+v"(low), "+v"(high));
  alignas(64) uint32_t words[kLanes];
  all_lanes([&](int i) { words[i] = test(i) ? ~0u : 0u; });
  low = _mm512_and_si512(low, _mm512_load_si512(words));
  high = _mm512_and_si512(high, _mm512_load_si512(words + 16));
  return LaneMask(_mm512_reduce_or_epi32(_mm512_or_si512(low, high)));
#else
  LaneMask mask = 0;
  for (int i = 0; i < kLanes; ++i) mask |= test(i) ? kLaneBit[i] : 0;
  return mask;
#endif
}

// Calls `run` as if all lanes executed, and then gives the other lanes of the destination their old values
// back. Handlers share this function, so each of them has code for a full warp only.
template <int kRows>
[[gnu::noinline]] void run_some_lanes(Warp& warp, const Inst& inst, const OpRow& row, Handler run) {
  const LaneMask exec = warp.exec;
  const auto predicates = warp.predicate;
  uint32_t* const out = warp.bank[0] + inst.operand.front() * kLanes;
  alignas(64) uint32_t old[kRows * kLanes];
  __builtin_memcpy(old, out, sizeof old);
  warp.exec = kAllLanes;
  run(warp, inst, row);
  warp.exec = exec;
  for (int first = 0; first < kRows * kLanes; first += kLanes)
    all_lanes([&](int i) { out[first + i] = (exec & kLaneBit[i]) != 0 ? out[first + i] : old[first + i]; });
  for (size_t p = 0; p < predicates.size(); ++p)
    warp.predicate[p] = (warp.predicate[p] & exec) | (predicates[p] & ~exec);
}

// Tells whether lanes are missing. If so, it has called `run` for the lanes that execute. R is the type of
// the first destination.
template <class R>
[[gnu::always_inline]] inline bool ran_some_lanes(Warp& warp, const Inst& inst, const OpRow& row,
                                                  Handler run) {
  if (warp.exec == kAllLanes) [[likely]]
    return false;
  run_some_lanes<sizeof(R) == 8 ? 2 : 1>(warp, inst, row, run);
  return true;
}

// Handles a value op: applies F to the sources of types A... lane by lane. F's result type is the
// destination: a bool goes to a predicate, 8 bytes go to a register pair, and 4 bytes go to a register.
template <class F, class... A>
[[gnu::flatten, gnu::noinline]] void run_value(Warp& warp, const Inst& inst, const OpRow& row) {
  using R = decltype(F{}(A{}...));
  [&]<size_t... N>(std::index_sequence<N...>) {
    const Slot* const slot = &inst.operand.front();
    const std::tuple<Source<A>...> source{Source<A>(warp, slot[N + 1])...};
    const auto value = [&](int i) { return F{}(std::get<N>(source).at(i)...); };
    if constexpr (std::is_same_v<R, bool>)
      write_predicate(warp, slot[0], mask_of(value));
    else if (!ran_some_lanes<R>(warp, inst, row, &run_value<F, A...>))
      write_all_lanes<R>(warp, slot[0], value);
  }
  (std::index_sequence_for<A...>{});
}

// Does the same for an F that gives Two<R, bool>. Either destination may be a source, so the predicate is a
// mask until the other result is written.
template <class F, class... A>
[[gnu::flatten]] void run_two_values(Warp& warp, const Inst& inst, const OpRow& row) {
  using R = decltype(F{}(A{}...).first);
  if (ran_some_lanes<R>(warp, inst, row, &run_two_values<F, A...>)) return;
  [&]<size_t... N>(std::index_sequence<N...>) {
    const Slot* const slot = &inst.operand.front();
    const std::tuple<Source<A>...> source{Source<A>(warp, slot[N + 2])...};
    const auto value = [&](int i) { return F{}(std::get<N>(source).at(i)...); };
    LaneMask second = 0;  // without a condition: carries come from predicates as well
    for (int i = 0; i < kLanes; ++i) second |= kLaneBit[i] & (LaneMask{0} - LaneMask(value(i).second));
    write_all_lanes<R>(warp, slot[0], [&](int i) { return value(i).first; });
    write_predicate(warp, slot[1], second);
  }
  (std::index_sequence_for<A...>{});
}

template <class T>
inline constexpr bool is_two = false;
template <class A, class B>
inline constexpr bool is_two<Two<A, B>> = true;

// Returns the instruction-mix class of a value op. Divisions and roots are sequences around the
// special-function unit: GPGPU-Sim puts them into its class SFU_OP, and so does the paper.
constexpr Class class_of(Unit unit) {
  return unit == Unit::Sfu || unit == Unit::FpDiv || unit == Unit::IntDiv || unit == Unit::Fp64Div
             ? Class::Sfu
             : Class::Alu;
}

template <class T>
constexpr OperandKind source_kind() {
  return std::is_same_v<T, bool> ? SrcPred : sizeof(T) == 8 ? Src64 : Src32;
}
template <class T>
constexpr OperandKind destination_kind() {
  return std::is_same_v<T, bool> ? DstPred : sizeof(T) == 8 ? Dst64 : Dst32;
}

// Makes a row whose handler applies `f` to sources of types A.... OpRow says what the other arguments mean.
// When `f` gives Two<R, S>, the row has two destinations.
template <class... A, class F>
constexpr OpRow value_op(std::string_view name, Unit unit, std::string_view doc, F, Examples examples) {
  using R = decltype(F{}(A{}...));
  OpRow row;
  row.name = name;
  row.klass = class_of(unit);
  row.unit = unit;
  if constexpr (is_two<R>) {
    row.operands = {destination_kind<decltype(R::first)>(), destination_kind<decltype(R::second)>(),
                    source_kind<A>()...};
    row.run = &run_two_values<F, A...>;
  } else {
    row.operands = {destination_kind<R>(), source_kind<A>()...};
    row.run = &run_value<F, A...>;
  }
  row.doc = doc;
  row.examples = examples;
  return row;
}
template <class A, class F>
constexpr OpRow unary(std::string_view name, Unit unit, std::string_view doc, F f, Examples examples) {
  return value_op<A>(name, unit, doc, f, examples);
}
template <class A, class F>
constexpr OpRow binary(std::string_view name, Unit unit, std::string_view doc, F f, Examples examples) {
  return value_op<A, A>(name, unit, doc, f, examples);
}
template <class A, class F>
constexpr OpRow ternary(std::string_view name, Unit unit, std::string_view doc, F f, Examples examples) {
  return value_op<A, A, A>(name, unit, doc, f, examples);
}

// Handles an op that is only an effect: the machine does everything.
void run_nothing(Warp& warp, const Inst& inst, const OpRow& row);

constexpr OpRow effect_op(std::string_view name, Class klass, Unit unit, Effect effect, Operands operands,
                          std::string_view doc) {
  OpRow row;
  row.name = name;
  row.klass = klass;
  row.unit = unit;
  row.operands = operands;
  row.effect = effect;
  row.run = &run_nothing;
  row.doc = doc;
  return row;
}

}  // namespace glint::isa::GLINT_ISA_PATH
