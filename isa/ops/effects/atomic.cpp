// Defines read-modify-write of memory: what each op makes of the old bits. The machine does the rest, lane by
// lane.
// SPDX-License-Identifier: Apache-2.0
#include "isa/atomic.h"

#include "isa/half.h"
#include "isa/op_makers.h"
#include "isa/ops/addresses.h"
#include "isa/ops/families.h"
#include "isa/ops/word.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Recordings show that global memory's adder takes subnormals for zeros and returns zeros for them, and that
// shared memory's adder keeps them.
float flushed(float x) {
  return (float_bits(x) & 0x7f80'0000u) == 0 ? float_of(float_bits(x) & 0x8000'0000u) : x;
}
uint64_t add_f32(uint64_t old, uint64_t b, uint64_t is_global) {
  const float x = float_of(uint32_t(old)), y = float_of(uint32_t(b));
  return float_bits(is_global ? flushed(canonical(flushed(x) + flushed(y))) : canonical(x + y));
}

bool is_nan64(uint64_t x) {
  return (x & 0x7fff'ffff'ffff'ffff) > 0x7ff0'0000'0000'0000;
}
constexpr uint64_t kQuiet = 0x0008'0000'0000'0000;

// Recordings show that NaNs keep their payload. Shared memory makes the result quiet and prefers the old
// value's NaN. Global memory's adder passes NaNs on unchanged and prefers the operand's.
uint64_t add_f64(uint64_t old, uint64_t b, uint64_t is_global) {
  if (is_global && is_nan64(b)) return b;
  if (is_nan64(old)) return is_global ? old : old | kQuiet;
  if (is_nan64(b)) return b | kQuiet;
  const uint64_t sum = double_bits(double_of(old) + double_of(b));
  return is_nan64(sum) ? 0xfff8'0000'0000'0000 : sum;
}

// f16 and bf16 are added in single precision. It has more than twice their digits, so rounding twice gives
// the same result as rounding once.
uint32_t add_half(uint32_t a, uint32_t b) {
  return to_half(to_float(Half{uint16_t(a)}) + to_float(Half{uint16_t(b)})).bits;
}
uint32_t add_bfloat(uint32_t a, uint32_t b) {
  return to_bfloat(to_float(Bfloat{uint16_t(a)}) + to_float(Bfloat{uint16_t(b)})).bits;
}
template <uint32_t (*kAdd)(uint32_t, uint32_t)>
uint64_t add_16(uint64_t old, uint64_t b, uint64_t) {
  return kAdd(uint32_t(old), uint32_t(b));
}
template <uint32_t (*kAdd)(uint32_t, uint32_t)>
uint64_t add_pair(uint64_t old, uint64_t b, uint64_t) {
  return kAdd(uint32_t(old), uint32_t(b)) | kAdd(uint32_t(old >> 16), uint32_t(b >> 16)) << 16;
}

template <class T>
uint64_t minimum(uint64_t old, uint64_t b, uint64_t) {
  return uint64_t(T(old) < T(b) ? T(old) : T(b));
}
template <class T>
uint64_t maximum(uint64_t old, uint64_t b, uint64_t) {
  return uint64_t(T(old) > T(b) ? T(old) : T(b));
}

// Returns the smaller or larger of two floats, given as bits in Int. A number wins against a NaN, and -0 is
// below +0 (IEEE 754-2019, minimumNumber). Choice: two NaNs give a quiet NaN, which Vulkan leaves open.
template <class Int, Int kInfinity, bool kLargest>
uint64_t extreme(uint64_t old, uint64_t other, uint64_t) {
  constexpr Int kMagnitude = Int(Int(~Int{0}) >> 1), kSign = Int(~kMagnitude), kQuietNan = Int(kMagnitude);
  const Int a = Int(old), b = Int(other);
  const bool a_nan = (a & kMagnitude) > kInfinity, b_nan = (b & kMagnitude) > kInfinity;
  if (a_nan) return b_nan ? kQuietNan : b;
  if (b_nan) return a;
  // The keys are sortable numbers: negative floats are reversed and come below the positive ones.
  const Int key_a = a & kSign ? Int(~a) : Int(a | kSign), key_b = b & kSign ? Int(~b) : Int(b | kSign);
  return (key_a < key_b) == !kLargest ? a : b;
}
constexpr uint32_t kInfinity32 = 0x7f80'0000;
constexpr uint64_t kInfinity64 = 0x7ff0'0000'0000'0000;

// The machine keeps as many low bits as the type has.
uint64_t add_integer(uint64_t old, uint64_t b, uint64_t) {
  return old + b;
}
uint64_t bits_and(uint64_t old, uint64_t b, uint64_t) {
  return old & b;
}
uint64_t bits_or(uint64_t old, uint64_t b, uint64_t) {
  return old | b;
}
uint64_t bits_xor(uint64_t old, uint64_t b, uint64_t) {
  return old ^ b;
}
uint64_t exchange(uint64_t, uint64_t b, uint64_t) {
  return b;
}
uint64_t increment(uint64_t old, uint64_t b, uint64_t) {
  return old >= b ? 0 : old + 1;
}
uint64_t decrement(uint64_t old, uint64_t b, uint64_t) {
  return old == 0 || old > b ? b : old - 1;
}
uint64_t compare_and_swap(uint64_t old, uint64_t expected, uint64_t value) {
  return old == expected ? value : old;
}

using enum AtomicKind;
struct Op {
  std::string_view suffix, what;
  uint8_t bytes;
  AtomicFunction function;
  AtomicKind kind = Integer;  // of a Swap: it takes two operands
  bool has_red = true;        // makes sense without the old value
};
constexpr Op kOps[] = {
    {"add.u32", "Adds", 4, &add_integer},
    {"add.s32", "Adds", 4, &add_integer},
    {"add.u64", "Adds", 8, &add_integer},
    {"add.f32", "Adds single precision", 4, &add_f32, FloatAdd},
    {"add.f64", "Adds double precision", 8, &add_f64, FloatAdd},
    {"add.noftz.f16", "Adds f16", 2, &add_16<&add_half>},
    {"add.noftz.f16x2", "Adds both f16 of a pair", 4, &add_pair<&add_half>},
    {"add.noftz.bf16", "Adds bf16", 2, &add_16<&add_bfloat>},
    {"add.noftz.bf16x2", "Adds both bf16 of a pair", 4, &add_pair<&add_bfloat>},
    {"min.u32", "Takes the minimum", 4, &minimum<uint32_t>},
    {"min.s32", "Takes the signed minimum", 4, &minimum<int32_t>},
    {"min.u64", "Takes the minimum", 8, &minimum<uint64_t>},
    {"min.s64", "Takes the signed minimum", 8, &minimum<int64_t>},
    {"min.f32", "Takes the single-precision minimum", 4, &extreme<uint32_t, kInfinity32, false>},
    {"min.f64", "Takes the double-precision minimum", 8, &extreme<uint64_t, kInfinity64, false>},
    {"max.u32", "Takes the maximum", 4, &maximum<uint32_t>},
    {"max.s32", "Takes the signed maximum", 4, &maximum<int32_t>},
    {"max.u64", "Takes the maximum", 8, &maximum<uint64_t>},
    {"max.s64", "Takes the signed maximum", 8, &maximum<int64_t>},
    {"max.f32", "Takes the single-precision maximum", 4, &extreme<uint32_t, kInfinity32, true>},
    {"max.f64", "Takes the double-precision maximum", 8, &extreme<uint64_t, kInfinity64, true>},
    {"and.b32", "Computes the bitwise and", 4, &bits_and},
    {"and.b64", "Computes the bitwise and", 8, &bits_and},
    {"or.b32", "Computes the bitwise or", 4, &bits_or},
    {"or.b64", "Computes the bitwise or", 8, &bits_or},
    {"xor.b32", "Computes the bitwise exclusive or", 4, &bits_xor},
    {"xor.b64", "Computes the bitwise exclusive or", 8, &bits_xor},
    {"inc.u32", "Counts up, or sets 0 from the operand on,", 4, &increment},
    {"dec.u32", "Counts down, or sets the operand for 0 and above the operand,", 4, &decrement},
    {"exch.b32", "Replaces 4 bytes by the operand", 4, &exchange, Integer, false},
    {"exch.b64", "Replaces 8 bytes by the operand", 8, &exchange, Integer, false},
    {"cas.b16", "Stores the second operand, if the first is there,", 2, &compare_and_swap, Swap, false},
    {"cas.b32", "Stores the second operand, if the first is there,", 4, &compare_and_swap, Swap, false},
    {"cas.b64", "Stores the second operand, if the first is there,", 8, &compare_and_swap, Swap, false},
};

struct Place {
  Space space;
  std::string_view suffix, what;
};
constexpr Place kPlaces[] = {{Space::Global, ".global.", "in global memory"},
                             {Space::Shared, ".shared.", "in shared memory"},
                             {Space::Generic, ".", "at a generic address"}};

constexpr size_t kNumReds = [] {
  size_t n = 0;
  for (const Op& op : kOps) n += op.has_red;
  return n;
}();
constexpr size_t kNumRows = std::size(kPlaces) * (std::size(kOps) + kNumReds);

// Calls `visit(place, op, returns)` for every row, in the order of the table.
template <class Visit>
constexpr void each_row(Visit&& visit) {
  for (const bool returns : {true, false})
    for (const Place& place : kPlaces)
      for (const Op& op : kOps)
        if (returns || op.has_red) visit(place, op, returns);
}

constexpr auto kNames = [] {
  std::array<Word, kNumRows> out{};
  size_t n = 0;
  each_row([&](const Place& place, const Op& op, bool returns) {
    out[n++] = Word{returns ? "atom" : "red", place.suffix, op.suffix};
  });
  return out;
}();
constexpr auto kSentences = [] {
  std::array<Word, kNumRows> out{};
  size_t n = 0;
  each_row([&](const Place& place, const Op& op, bool returns) {
    out[n++] = Word{op.what, " ", place.what, returns ? " and returns the old value." : "."};
  });
  return out;
}();

constexpr OpRow atomic_row(size_t n, const Place& place, const Op& op, bool returns) {
  const bool is_wide = place.space != Space::Shared, is_64 = op.bytes == 8;
  const OperandKind address = is_wide ? Address64 : Address32, source = is_64 ? Src64 : Src32;
  Operands operands;
  if (returns) operands.kind[operands.count++] = is_64 ? Dst64 : Dst32;
  operands.kind[operands.count++] = address;
  operands.kind[operands.count++] = source;
  if (op.kind == Swap) operands.kind[operands.count++] = source;
  OpRow row =
      effect_op(kNames[n].view(), Class::Mem, Unit::Lsu, Effect::Atomic, operands, kSentences[n].view());
  row.memory = {place.space, op.bytes, 1, false};
  row.atomic = op.function;
  row.detail = uint16_t(op.kind);
  row.run = is_wide   ? returns ? &form_addresses<uint64_t, 1> : &form_addresses<uint64_t, 0>
              : returns ? &form_addresses<uint32_t, 1>
                      : &form_addresses<uint32_t, 0>;
  return row;
}

constexpr auto kRows = [] {
  std::array<OpRow, kNumRows> out{};
  size_t n = 0, red = std::size(kPlaces) * std::size(kOps);  // the rows without the old value come last
  each_row([&](const Place& place, const Op& op, bool returns) {
    out[n] = atomic_row(n, place, op, returns);
    if (returns && op.has_red) out[n].reduction = kNames[red++].view();
    ++n;
  });
  return out;
}();

}  // namespace

RowList atomic_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
