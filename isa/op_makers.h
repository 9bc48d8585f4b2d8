// Makers of op rows: they wrap the work of one lane into a handler for the whole warp.
//
// Included only by isa/ops/*.cpp, which are compiled once for each SIMD path. Everything here lies in a
// namespace of its path, and rows pass lambdas of an unnamed namespace: no path can link another's code.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <tuple>
#include <type_traits>
#include <utility>

#include "isa/kernels.h"
#include "isa/op_row.h"

namespace glint::isa::GLINT_ISA_PATH {

using enum OperandKind;

// Bit i of entry i: the mask bit of each lane, as data, so that masks are tested a vector at a time.
inline constexpr LaneMask kLaneBit[kLanes] = {
    1u << 0,  1u << 1,  1u << 2,  1u << 3,  1u << 4,  1u << 5,  1u << 6,  1u << 7,
    1u << 8,  1u << 9,  1u << 10, 1u << 11, 1u << 12, 1u << 13, 1u << 14, 1u << 15,
    1u << 16, 1u << 17, 1u << 18, 1u << 19, 1u << 20, 1u << 21, 1u << 22, 1u << 23,
    1u << 24, 1u << 25, 1u << 26, 1u << 27, 1u << 28, 1u << 29, 1u << 30, 1u << 31};

// Calls `lane(i)` for all lanes. Rows are equal or disjoint and a lane touches only its own column, so no
// lane depends on another: the compiler is told, because it cannot know.
template <class Lane>
[[gnu::always_inline]] inline void all_lanes(Lane&& lane) {
#if defined(__clang__)
#pragma clang loop vectorize(assume_safety)
#else
#pragma GCC ivdep
#endif
  for (int i = 0; i < kLanes; ++i) lane(i);
}

// A source operand of type T: reads the bits of one lane. 64-bit operands are two rows, low half first.
template <class T>
struct Source {
  const uint32_t* low;
  const uint32_t* high;
  [[gnu::always_inline]] Source(const Warp& warp, Slot slot)
      : low(warp.bank[slot >> kBankShift] + (slot & kSlotIndexMask) * kLanes), high(low + kLanes) {}
  [[gnu::always_inline]] T at(int i) const {
    if constexpr (sizeof(T) == 8)
      return T(uint64_t(low[i]) | uint64_t(high[i]) << 32);
    else
      return __builtin_bit_cast(T, low[i]);
  }
};

// A predicate operand: reads the bit of one lane.
template <>
struct Source<bool> {
  LaneMask mask;
  [[gnu::always_inline]] Source(const Warp& warp, Slot slot) : mask(*(&warp.predicate.front() + slot)) {}
  [[gnu::always_inline]] bool at(int i) const { return (mask & kLaneBit[i]) != 0; }
};

template <class T>
[[gnu::always_inline]] inline uint32_t bits_of(T x) {
  return __builtin_bit_cast(uint32_t, x);
}

// Runs `value(i)` for all lanes and keeps it for those of `exec`; R says how wide a result row is.
template <class R, class Value>
[[gnu::always_inline]] inline void write_lanes(Warp& warp, Slot slot, Value&& value) {
  uint32_t* const low = warp.bank[0] + slot * kLanes;
  const LaneMask exec = warp.exec;
  if constexpr (sizeof(R) == 8) {
    uint32_t* const high = low + kLanes;
    if (exec == kAllLanes) [[likely]] {
      all_lanes([&](int i) {
        const uint64_t x = uint64_t(value(i));
        low[i] = uint32_t(x);
        high[i] = uint32_t(x >> 32);
      });
      return;
    }
    all_lanes([&](int i) {
      const uint64_t x = uint64_t(value(i));
      const bool write = (exec & kLaneBit[i]) != 0;
      low[i] = write ? uint32_t(x) : low[i];
      high[i] = write ? uint32_t(x >> 32) : high[i];
    });
  } else {
    if (exec == kAllLanes) [[likely]] {
      all_lanes([&](int i) { low[i] = bits_of(value(i)); });
      return;
    }
    all_lanes([&](int i) {
      const uint32_t x = bits_of(value(i));
      low[i] = (exec & kLaneBit[i]) != 0 ? x : low[i];
    });
  }
}

// Writes a predicate: the lanes of `exec` take their bit of `mask`.
[[gnu::always_inline]] inline void write_predicate(Warp& warp, Slot slot, LaneMask mask) {
  LaneMask& out = *(&warp.predicate.front() + slot);
  out = (out & ~warp.exec) | (mask & warp.exec);
}

// The mask of the lanes where `test(i)` is true.
template <class Test>
[[gnu::always_inline]] inline LaneMask mask_of(Test&& test) {
  LaneMask mask = 0;
  for (int i = 0; i < kLanes; ++i) mask |= test(i) ? kLaneBit[i] : 0;
  return mask;
}

// Handler of a value op: applies F to the sources of types A... lane by lane. F's result type is the
// destination: bool a predicate, 8 bytes a register pair, 4 bytes a register.
template <class F, class... A>
[[gnu::flatten]] void run_value(Warp& warp, const Inst& inst) {
  [&]<size_t... N>(std::index_sequence<N...>) {
    const Slot* const slot = &inst.operand.front();
    const std::tuple<Source<A>...> source{Source<A>(warp, slot[N + 1])...};
    const auto value = [&](int i) { return F{}(std::get<N>(source).at(i)...); };
    using R = decltype(value(0));
    if constexpr (std::is_same_v<R, bool>)
      write_predicate(warp, slot[0], mask_of(value));
    else
      write_lanes<R>(warp, slot[0], value);
  }
  (std::index_sequence_for<A...>{});
}

template <class T>
constexpr OperandKind source_kind() {
  return std::is_same_v<T, bool> ? SrcPred : sizeof(T) == 8 ? Src64 : Src32;
}
template <class T>
constexpr OperandKind destination_kind() {
  return std::is_same_v<T, bool> ? DstPred : sizeof(T) == 8 ? Dst64 : Dst32;
}

// A row whose handler applies `f` to sources of types A...; units, documentation and examples as OpRow says.
template <class... A, class F>
constexpr OpRow value_op(std::string_view name, Unit unit, std::string_view doc, F, Examples examples) {
  using R = decltype(F{}(A{}...));
  OpRow row;
  row.name = name;
  // Divisions and roots are sequences around the special-function unit: GPGPU-Sim's SFU_OP class, and so the paper's.
  row.klass = unit == Unit::Sfu || unit == Unit::FpDiv || unit == Unit::IntDiv ? Class::Sfu : Class::Alu;
  row.unit = unit;
  row.operands = {destination_kind<R>(), source_kind<A>()...};
  row.run = &run_value<F, A...>;
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

// Handler of an op that is all effect: the machine does everything.
void run_nothing(Warp& warp, const Inst& inst);

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
