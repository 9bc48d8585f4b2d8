// Checks atomics and reductions against a scalar model of one lane after the other, whose lanes collide.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "isa/generic_address.h"
#include "tests/ops/numbers.h"
#include "tests/ops/op_lab.h"
#include "tests/ops/oracle.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

using isa::Space;

// Says what the name of an atomic asks for.
struct Atomic {
  bool returns = false;
  Space space = Space::Generic;
  std::string_view verb, type;
  uint32_t bytes = 0;
};
Atomic atomic_of(std::string_view name) {
  Atomic out;
  const auto parts = parts_of(name);
  out.returns = parts.front() == "atom";
  out.type = parts.back();
  for (std::string_view part : parts) {
    if (part == "global") out.space = Space::Global;
    if (part == "shared") out.space = Space::Shared;
  }
  out.verb = parts[out.space == Space::Generic ? 1 : 2];
  out.bytes = out.type.ends_with("64") ? 8 : out.type.ends_with("32") || out.type.ends_with("x2") ? 4 : 2;
  return out;
}

// Adds floats. Global memory's adder flushes subnormals of single precision; recordings of a GPU show how
// NaNs of double precision go through.
uint32_t add_single(uint32_t a, uint32_t b, bool is_global) {
  const auto flush = [&](uint32_t x) { return is_global && (x & 0x7f80'0000) == 0 ? x & 0x8000'0000 : x; };
  const double sum = value_of(kSingle, flush(a)) + value_of(kSingle, flush(b));
  return std::isnan(sum) ? 0x7fff'ffff : flush(uint32_t(bits_of(kSingle, sum)));
}
uint64_t add_double(uint64_t a, uint64_t b, bool is_global) {
  const double x = std::bit_cast<double>(a), y = std::bit_cast<double>(b), sum = x + y;
  constexpr uint64_t kQuiet = uint64_t{1} << 51;
  if (is_global && std::isnan(y)) return b;
  if (std::isnan(x)) return is_global ? a : a | kQuiet;
  if (std::isnan(y)) return b | kQuiet;
  return std::isnan(sum) ? 0xfff8'0000'0000'0000 : std::bit_cast<uint64_t>(sum);
}
uint32_t add_small(const FloatFormat& format, uint32_t a, uint32_t b) {
  const double sum = value_of(format, a) + value_of(format, b);
  return std::isnan(sum) ? 0x7fff : uint32_t(bits_of(format, sum));
}

// Takes the smaller or the larger number. A number wins against a NaN, and -0 is below +0.
uint64_t extreme_of(const FloatFormat& format, uint64_t a, uint64_t b, bool smaller) {
  const double x = value_of(format, a), y = value_of(format, b);
  if (std::isnan(x) && std::isnan(y)) return ~uint64_t{0} >> (65 - format.bits());
  if (std::isnan(x) || std::isnan(y)) return std::isnan(x) ? b : a;
  if (x == y) return std::signbit(x) == smaller ? a : b;
  return (x < y) == smaller ? a : b;
}

uint64_t minmax(const Atomic& op, uint64_t a, uint64_t b) {
  const bool smaller = op.verb == "min";
  if (op.type.starts_with("f")) return extreme_of(op.bytes == 8 ? kDouble : kSingle, a, b, smaller);
  if (op.type == "u32" || op.type == "u64") return (a < b) == smaller ? a : b;
  const auto as_signed = [&](uint64_t x) { return int64_t(x << (64 - 8 * op.bytes)); };
  return (as_signed(a) < as_signed(b)) == smaller ? a : b;
}

uint64_t sum_of(const Atomic& op, uint64_t a, uint64_t b, bool is_global) {
  if (op.type == "f32") return add_single(uint32_t(a), uint32_t(b), is_global);
  if (op.type == "f64") return add_double(a, b, is_global);
  if (!op.type.starts_with("f") && !op.type.starts_with("bf")) return a + b;
  const FloatFormat& format = op.type.starts_with("b") ? kBfloat : kHalf;
  const uint64_t low = add_small(format, uint32_t(a & 0xffff), uint32_t(b & 0xffff));
  return op.bytes == 2 ? low : low | uint64_t{add_small(format, uint32_t(a >> 16), uint32_t(b >> 16))} << 16;
}

// Returns what is in memory after one lane's turn. All values have only the bits of the type.
uint64_t turn(const Atomic& op, uint64_t old, uint64_t b, uint64_t c, bool is_global) {
  if (op.verb == "add") return sum_of(op, old, b, is_global);
  if (op.verb == "min" || op.verb == "max") return minmax(op, old, b);
  if (op.verb == "and") return old & b;
  if (op.verb == "or") return old | b;
  if (op.verb == "xor") return old ^ b;
  if (op.verb == "exch") return b;
  if (op.verb == "cas") return old == b ? c : old;
  if (op.verb == "inc") return old >= b ? 0 : old + 1;
  if (op.verb == "dec") return old == 0 || old > b ? b : old - 1;
  throw std::logic_error(fmt::format("the oracle does not know the atomic '{}'", op.verb));
}

// Returns a value that is often special: small numbers, which meet in a compare-and-swap, and NaNs,
// infinities, zeros and subnormals of the type.
uint64_t value_for(const Atomic& op, Random& random) {
  const uint64_t r = random.next(), mask = ~uint64_t{0} >> (64 - 8 * op.bytes);
  if (op.verb == "cas" || op.verb == "inc" || op.verb == "dec")
    return r % 4 | (r >> 60 == 0 ? 1ull << (8 * op.bytes - 1) : 0);
  if (!op.type.starts_with("f") && !op.type.starts_with("bf")) return (r >> 62 ? r : r % 8) & mask;
  const FloatFormat& format = op.type == "f32"           ? kSingle
                              : op.type == "f64"         ? kDouble
                              : op.type.starts_with("f") ? kHalf
                                                         : kBfloat;
  uint64_t out = corner_of(format, r);
  if (op.type.ends_with("x2")) out |= corner_of(format, random.next()) << 16;
  return out;
}

void put(uint8_t* to, uint64_t value, uint32_t bytes) {
  for (uint32_t i = 0; i < bytes; ++i) to[i] = uint8_t(value >> (8 * i));
}
uint64_t get(const uint8_t* from, uint32_t bytes) {
  uint64_t out = 0;
  for (uint32_t i = 0; i < bytes; ++i) out |= uint64_t{from[i]} << (8 * i);
  return out;
}

uint64_t check_once(const isa::OpRow& row, const Atomic& op, uint64_t enabled, uint64_t seed) {
  constexpr uint32_t kCells = 5;  // Each warp has cells of its own, in which its lanes collide.
  OpLab lab(row, 16);
  Random random{seed};
  Spaces before = lab.random_spaces(random);
  for (Bytes* bytes : {&before.global, &before.shared})
    for (size_t at = 0; at < bytes->size(); at += op.bytes)
      put(bytes->data() + at, value_for(op, random), op.bytes);
  Spaces expected = before;
  const bool is_wide = op.space != Space::Shared, swaps = op.verb == "cas";
  const size_t words = op.bytes == 8 ? 2 : 1, first = is_wide ? 2 : 1;
  REQUIRE(lab.num_sources() == first + (swaps ? 2 : 1) * words);
  REQUIRE(lab.num_results() == (op.returns ? words : 0));
  std::vector<Column> sources(lab.num_sources()), results(lab.num_results());
  for (size_t t = 0; t < kThreads; ++t) {
    const Space space = op.space != Space::Generic ? op.space
                        : random.below(2)          ? Space::Global
                                                   : Space::Shared;
    const uint32_t offset = uint32_t(t / 32) * 512 + 64 + random.below(kCells) * op.bytes;
    uint64_t address = offset + (space == Space::Global ? lab.global_base() : 0) - 16;
    if (op.space == Space::Generic) address += isa::window_of(space);
    sources[0][t] = uint32_t(address);
    if (is_wide) sources[1][t] = uint32_t(address >> 32);
    const uint64_t b = value_for(op, random), c = value_for(op, random);
    for (size_t w = 0; w < words; ++w) {
      // Bits above a narrow type must not count.
      const auto upper = op.bytes == 2 ? uint32_t(random.next()) << 16 : 0;
      sources[first + w][t] = uint32_t(b >> (32 * w)) | upper;
      if (swaps) sources[first + words + w][t] = uint32_t(c >> (32 * w)) | upper;
      if (op.returns) results[w][t] = OpLab::kUntouched;
    }
    if (!(enabled >> t & 1)) continue;
    uint8_t* const cell = (space == Space::Global ? expected.global : expected.shared).data() + offset;
    const uint64_t old = get(cell, op.bytes);
    put(cell, turn(op, old, b, c, space == Space::Global), op.bytes);
    for (size_t w = 0; w < results.size(); ++w) results[w][t] = uint32_t(old >> (32 * w));
  }
  const Outcome outcome = lab.run(sources, enabled, before);
  CHECK(difference(outcome, results, expected) == "");
  return outcome.lanes;
}

}  // namespace

uint64_t check_atomic(const isa::OpRow& row) {
  const Atomic op = atomic_of(row.name);
  return check_once(row, op, ~uint64_t{0}, 1) + check_once(row, op, 0x8421'0f07'fff7'9bdf, 2) +
         check_once(row, op, ~uint64_t{0}, 3);
}

}  // namespace glint::test
