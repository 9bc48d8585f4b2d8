// Defines arithmetic with a carry: add.cc, addc, sub.cc, subc, mad.cc, madc.
//
// PTX has one hidden carry. In Glint the carry is a predicate operand, which is also the borrow of
// subtractions.
// SPDX-License-Identifier: Apache-2.0
#include "isa/integer_kernels.h"
#include "isa/ops/families.h"
#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Returns a + b + carry and the carry out, with both numbers taken as unsigned. The carry out of the top bit
// is that of a full adder, which compilers vectorise better than comparisons.
template <class T>
inline Two<T, bool> sum_with_carry(T a, T b, bool carry) {
  using U = Unsigned<T>;
  const U x = U(a), y = U(b), sum = x + y + U(carry);
  const U out = (x & y) | ((x | y) & ~sum);
  return {T(sum), std::make_signed_t<U>(out) < 0};
}
template <class T>
inline Two<T, bool> difference_with_borrow(T a, T b, bool borrow) {
  using U = Unsigned<T>;
  const U x = U(a), y = U(b), difference = x - y - U(borrow);
  const U out = (~x & y) | ((~x | y) & difference);
  return {T(difference), std::make_signed_t<U>(out) < 0};
}

// Signed and unsigned numbers give the same bits and share handlers.
struct Sum {
  template <class T>
  auto operator()(T a, T b) const {
    return sum_with_carry(a, b, false);
  }
  template <class T>
  auto operator()(T a, T b, bool c) const {
    return sum_with_carry(a, b, c);
  }
};
struct Difference {
  template <class T>
  auto operator()(T a, T b) const {
    return difference_with_borrow(a, b, false);
  }
  template <class T>
  auto operator()(T a, T b, bool c) const {
    return difference_with_borrow(a, b, c);
  }
};
template <class F>
struct WithoutCarry {
  template <class T>
  T operator()(T a, T b, bool c) const {
    return F{}(a, b, c).first;
  }
};

template <class N>
constexpr auto sum_rows() {
  using T = Unsigned<typename N::Type>;
  constexpr uint64_t kOnes = word(T(-1));
  return joined_rows(
      binary<T>(joined<"add.cc", N::kName>, Unit::Int, "Adds. The predicate is the carry out.", Sum{},
                {{{1, 2}, 3, 0}, {{kOnes, 1}, 0, 1}}),
      value_op<T, T, bool>(joined<"addc", N::kName>, Unit::Int, "Adds two numbers and a carry.",
                           WithoutCarry<Sum>{}, {{{1, 2, 0}, 3}, {{1, 2, 1}, 4}}),
      value_op<T, T, bool>(joined<"addc.cc", N::kName>, Unit::Int,
                           "Adds two numbers and a carry. The predicate is the carry out.", Sum{},
                           {{{1, 2, 1}, 4, 0}, {{kOnes, kOnes, 1}, kOnes, 1}, {{kOnes, 0, 1}, 0, 1}}),
      binary<T>(joined<"sub.cc", N::kName>, Unit::Int, "Subtracts. The predicate is the borrow.",
                Difference{}, {{{3, 2}, 1, 0}, {{0, 1}, kOnes, 1}}),
      value_op<T, T, bool>(joined<"subc", N::kName>, Unit::Int, "Subtracts a number and a borrow.",
                           WithoutCarry<Difference>{}, {{{3, 2, 0}, 1}, {{3, 2, 1}, 0}}),
      value_op<T, T, bool>(joined<"subc.cc", N::kName>, Unit::Int,
                           "Subtracts a number and a borrow. The predicate is the borrow out.", Difference{},
                           {{{3, 2, 1}, 0, 0}, {{0, kOnes, 1}, 0, 1}, {{0, 0, 1}, kOnes, 1}}));
}

template <bool kHigh, class T>
inline T half_product(T a, T b) {
  return kHigh ? product_high(a, b) : T(Wrapping<T>(a) * Wrapping<T>(b));
}
// Handles the product rows with a carry out. It computes the product, which is the most expensive part, once
// for both results.
template <class T, bool kHigh, bool kCarryIn>
[[gnu::flatten]] void run_product(Warp& warp, const Inst& inst, const OpRow& row) {
  if (ran_some_lanes<T>(warp, inst, row, &run_product<T, kHigh, kCarryIn>)) return;
  const Slot* const slot = &inst.operand.front();
  const Source<T> a(warp, slot[2]), b(warp, slot[3]), c(warp, slot[4]);
  const Source<bool> carry(warp, kCarryIn ? slot[5] : Slot(0));
  alignas(64) T product[kLanes];
  all_lanes([&](int i) { product[i] = half_product<kHigh>(a.at(i), b.at(i)); });
  const auto sum = [&](int i) { return sum_with_carry(product[i], c.at(i), kCarryIn && carry.at(i)); };
  LaneMask out = 0;
  for (int i = 0; i < kLanes; ++i) out |= kLaneBit[i] & (LaneMask{0} - LaneMask(sum(i).second));
  write_all_lanes<T>(warp, slot[0], [&](int i) { return sum(i).first; });
  write_predicate(warp, slot[1], out);
}
constexpr OpRow with_handler(OpRow row, Handler run) {
  row.run = run;
  return row;
}
template <bool kHigh>
struct ProductSum {
  template <class T>
  T operator()(T a, T b, T c, bool carry) const {
    return sum_with_carry(half_product<kHigh>(a, b), c, carry).first;
  }
};
template <class N, Text kHalf, bool kHigh>
constexpr auto product_rows() {
  // The low half of a product has no sign.
  using T = std::conditional_t<kHigh, typename N::Type, Unsigned<typename N::Type>>;
  constexpr uint64_t kOnes = word(T(-1));
  constexpr uint64_t kProduct = kHigh ? 0 : 15;  // of 3 and 5
  return joined_rows(
      with_handler(ternary<T>(joined<"mad", kHalf, ".cc", N::kName>, Unit::Int,
                              "Adds half of a product and the third source. The predicate is the carry out.",
                              [](T, T, T) { return Two<T, bool>{}; },
                              {{{3, 5, 1}, kProduct + 1, 0}, {{3, 5, kOnes}, kHigh ? kOnes : 14, !kHigh}}),
                   &run_product<T, kHigh, false>),
      value_op<T, T, T, bool>(joined<"madc", kHalf, N::kName>, Unit::Int,
                              "Adds half of a product, the third source and a carry.", ProductSum<kHigh>{},
                              {{{3, 5, 1, 0}, kProduct + 1}, {{3, 5, 1, 1}, kProduct + 2}}),
      with_handler(
          value_op<T, T, T, bool>(
              joined<"madc", kHalf, ".cc", N::kName>, Unit::Int,
              "Adds half of a product, the third source and a carry. The predicate is the carry out.",
              [](T, T, T, bool) { return Two<T, bool>{}; },
              {{{3, 5, 1, 1}, kProduct + 2, 0}, {{3, 5, kOnes, 1}, kProduct, 1}}),
          &run_product<T, kHigh, true>));
}

constexpr auto kRows = rows_of_types<TypeS32, TypeU32, TypeS64, TypeU64>([]<class N>() {
  return joined_rows(sum_rows<N>(), product_rows<N, ".lo", false>(), product_rows<N, ".hi", true>());
});

}  // namespace

RowList carry_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
