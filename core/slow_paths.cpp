// Finds the operands that divisions, reciprocals and square roots hand to routines, as sm_90's machine code
// does.
// SPDX-License-Identifier: Apache-2.0
#include "core/slow_paths.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/check.h"

namespace glint::core {
namespace {

// Names a way through a routine. None: the short sequence does it.
enum class Way : uint8_t {
  None,
  NotANumber,
  Invalid,
  Zero,
  Infinite,
  Long,
  Rounded,
  Scaled,
  ScaledRounded,
  Count
};

// Holds the time of a routine. Sources: the machine instructions of each way are counted in the code that
// nvcc 13.0 makes for sm_90, with the call and the return. The latencies are what a chain of ops takes longer
// on an H100 with one such lane in the warp than with none (bench/probes/README.md).
struct Routine {
  std::array<SlowTime, size_t(Way::Count)> ways;
  uint32_t common;   // instructions that all ways share
  uint32_t further;  // cycles for each further way that lanes of the warp take
  SlowTime spared;   // what a warp saves whose lanes all take the routine
};

// The ways are: none, not a number, invalid, zero, infinite, long, rounded, scaled, scaled and rounded.
constexpr Routine kDivF32{
    {{{}, {24, 159}, {27, 181}, {34, 223}, {38, 249}, {44, 253}, {72, 350}, {67, 382}, {95, 479}}},
    23,
    29,
    {0, 17}};
constexpr Routine kRcpF32{{{{}, {15, 161}, {}, {21, 191}, {15, 161}, {44, 261}, {}, {}, {}}}, 8, 30, {4, 49}};
constexpr Routine kSqrtF32{
    {{{}, {17, 163}, {14, 143}, {11, 123}, {27, 215}, {27, 217}, {}, {}, {}}}, 9, 61, {4, 31}};
constexpr Routine kDivF64{
    {{{}, {52, 233}, {56, 262}, {64, 290}, {64, 290}, {59, 254}, {75, 312}, {}, {}}}, 48, 30, {0, 18}};
constexpr Routine kRcpF64{
    {{{}, {15, 128}, {}, {19, 147}, {}, {34, 257}, {}, {31, 240}, {}}}, 13, 30, {0, 16}};
constexpr Routine kSqrtF64{
    {{{}, {}, {18, 169}, {15, 160}, {21, 199}, {20, 168}, {}, {36, 279}, {}}}, 12, 30, {0, 16}};

constexpr uint32_t kSignless = 0x7fff'ffff;

struct Single {
  explicit Single(uint32_t bits) : magnitude(bits & kSignless), exponent(magnitude >> 23) {}
  bool is_nan() const { return magnitude > 0x7f80'0000; }
  bool is_infinite() const { return magnitude == 0x7f80'0000; }
  double value() const { return double(std::bit_cast<float>(magnitude)); }
  uint32_t magnitude, exponent;
};
struct Double {
  explicit Double(uint64_t bits) : magnitude(bits << 1 >> 1), high(uint32_t(magnitude >> 32)) {}
  bool is_nan() const { return magnitude > uint64_t{0x7ff0'0000} << 32; }
  bool is_infinite() const { return magnitude == uint64_t{0x7ff0'0000} << 32; }
  uint64_t magnitude;
  uint32_t high;
};

template <class Number>
Way special_quotient(const Number& a, const Number& b) {
  if (a.is_nan() || b.is_nan()) return Way::NotANumber;
  if ((a.magnitude | b.magnitude) == 0 || (a.is_infinite() && b.is_infinite())) return Way::Invalid;
  if (a.is_infinite() || b.magnitude == 0) return Way::Infinite;
  return b.is_infinite() || a.magnitude == 0 ? Way::Zero : Way::Long;
}

// The check looks at exponents alone. An H100 was asked for all 65,536 pairs of them, with three pairs of
// fractions (bench/probes/README.md). Model: results that overflow, or become zero, take the way of others.
Way way_of_div_f32(Single a, Single b, bool flushes) {
  const int distance = int(a.exponent) - int(b.exponent);
  if (b.exponent >= 2 && b.exponent <= 251 && a.exponent >= 25 && a.exponent <= 254 && distance >= -124 &&
      distance <= 126)
    return Way::None;
  if (flushes && a.exponent == 0) a.magnitude = 0;
  if (flushes && b.exponent == 0) b.magnitude = 0;
  const Way way = special_quotient(a, b);
  if (way != Way::Long) return way;
  const double quotient = a.value() / b.value();
  const bool rounded = !flushes && quotient < 0x1p-126 && quotient >= 0x1p-150;
  if (a.exponent == 0 || b.exponent == 0) return rounded ? Way::ScaledRounded : Way::Scaled;
  return rounded ? Way::Rounded : Way::Long;
}

Way way_of_rcp_f32(Single a) {
  if (a.exponent >= 1 && a.exponent <= 252) return Way::None;
  if (a.is_nan()) return Way::NotANumber;
  if (a.is_infinite()) return Way::Infinite;
  return a.exponent == 0 ? Way::Zero : Way::Long;
}

Way way_of_sqrt_f32(uint32_t bits, bool flushes) {
  if (bits >= 0x0d00'0000 && bits < 0x7f80'0000) return Way::None;
  const Single a(bits);
  if (a.magnitude == 0 || (flushes && a.exponent == 0)) return Way::Zero;
  if (a.is_nan()) return Way::NotANumber;
  if (bits > kSignless) return Way::Invalid;
  return a.is_infinite() ? Way::Infinite : Way::Long;
}

// The check reads the high words of the numerator and of the quotient as single floats.
Way way_of_div_f64(uint64_t bits_a, uint64_t bits_b) {
  const Double a(bits_a), b(bits_b);
  const Double quotient(
      std::bit_cast<uint64_t>(std::bit_cast<double>(bits_a) / std::bit_cast<double>(bits_b)));
  const bool is_short = a.high >= 0x0360'0000 && b.high >= 0x0010'0000 && b.high < 0x7f80'0000 &&
                        quotient.high > 0x0010'0000 && quotient.high <= 0x7f80'0000;
  if (is_short) return Way::None;
  const Way way = special_quotient(a, b);
  return way == Way::Long && quotient.high < 0x0010'0000 ? Way::Rounded : way;
}

Way way_of_rcp_f64(Double a) {
  if (a.high >= 0x0010'0000 && a.high < 0x7fcf'fbfe) return Way::None;
  if (a.is_nan()) return Way::NotANumber;
  if (a.is_infinite() || a.magnitude == 0) return Way::Zero;
  return a.high < 0x0100'0001 ? Way::Scaled : Way::Long;
}

Way way_of_sqrt_f64(uint64_t bits) {
  const auto high = uint32_t(bits >> 32);
  if (high >= 0x0350'0000 && high < 0x7ff0'0000) return Way::None;
  const Double a(bits);
  if (a.is_nan() || a.magnitude == 0) return Way::Zero;
  if (high > kSignless) return Way::Invalid;
  if (a.is_infinite()) return Way::Infinite;
  return high < 0x0010'0000 ? Way::Scaled : Way::Long;
}

// Adds up the ways that the lanes take.
template <class WayOf>
SlowTime add_up(const Routine& routine, LaneMask lanes, WayOf&& way_of) {
  uint32_t ways = 0;
  for_each_lane(lanes, [&](int lane) { ways |= 1u << uint32_t(way_of(lane)); });
  constexpr uint32_t kShort = 1u << uint32_t(Way::None);
  const bool all = (ways & kShort) == 0;
  ways &= ~kShort;
  if (ways == 0) return {};
  SlowTime out{routine.common, 0};
  for (uint32_t rest = ways; rest; rest &= rest - 1) {
    const SlowTime& way = routine.ways[size_t(std::countr_zero(rest))];
    out.issues += way.issues - routine.common;
    out.latency = std::max(out.latency, way.latency);
  }
  out.latency += (uint32_t(std::popcount(ways)) - 1) * routine.further;
  if (all) out = {out.issues - routine.spared.issues, out.latency - routine.spared.latency};
  return out;
}

}  // namespace

SlowTime slow_time(SlowPath path, const isa::Warp& warp, const isa::Inst& inst, LaneMask lanes) {
  const uint32_t* a = warp.read(inst.operand[1]);
  const uint32_t* b = warp.read(inst.operand[2]);
  const auto wide = [](const uint32_t* row, int lane) {
    return row[lane] | uint64_t{row[lane + kLanes]} << 32;
  };
  switch (path) {
    case SlowPath::None:
      return {};
    case SlowPath::DivF32:
    case SlowPath::DivFtzF32:
      return add_up(kDivF32, lanes, [&](int lane) {
        return way_of_div_f32(Single(a[lane]), Single(b[lane]), path == SlowPath::DivFtzF32);
      });
    case SlowPath::RcpF32:
      return add_up(kRcpF32, lanes, [&](int lane) { return way_of_rcp_f32(Single(a[lane])); });
    case SlowPath::SqrtF32:
    case SlowPath::SqrtFtzF32:
      return add_up(kSqrtF32, lanes,
                    [&](int lane) { return way_of_sqrt_f32(a[lane], path == SlowPath::SqrtFtzF32); });
    case SlowPath::DivF64:
      return add_up(kDivF64, lanes, [&](int lane) { return way_of_div_f64(wide(a, lane), wide(b, lane)); });
    case SlowPath::RcpF64:
      return add_up(kRcpF64, lanes, [&](int lane) { return way_of_rcp_f64(Double(wide(a, lane))); });
    case SlowPath::SqrtF64:
      return add_up(kSqrtF64, lanes, [&](int lane) { return way_of_sqrt_f64(wide(a, lane)); });
  }
  GLINT_PANIC("slow path {}", int(path));
}

}  // namespace glint::core
