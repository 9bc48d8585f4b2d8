// Defines comparisons of integers.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "isa/ops/comparisons.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

template <class N>
struct Integer : N {
  using Type = typename N::Type;
  static constexpr auto kFlush = Text("");
  static constexpr Unit kUnit = Unit::Int;
  // The examples use two numbers whose order changes when the wrong signedness is taken.
  static constexpr uint64_t kOne = std::is_signed_v<Type> ? word(Type(-1)) : 1;
  static constexpr uint64_t kTwo = std::is_signed_v<Type> ? 1 : word(Type(-1));
  [[gnu::always_inline]] static Type value(Type x) { return x; }
};

template <class N>
constexpr auto equality_rows() {
  return joined_rows(
      relation_rows<Relation<".eq", IsEqual, 0, 1, 0>, Integer<N>>("Gives true where a == b."),
      relation_rows<Relation<".ne", IsNotEqual, 1, 0, 1>, Integer<N>>("Gives true where a != b."));
}
template <class N>
constexpr auto order_rows() {
  return joined_rows(
      equality_rows<N>(),
      relation_rows<Relation<".lt", IsLess, 1, 0, 0>, Integer<N>>("Gives true where a < b."),
      relation_rows<Relation<".le", IsLessOrEqual, 1, 1, 0>, Integer<N>>("Gives true where a <= b."),
      relation_rows<Relation<".gt", IsGreater, 0, 0, 1>, Integer<N>>("Gives true where a > b."),
      relation_rows<Relation<".ge", IsGreaterOrEqual, 0, 1, 1>, Integer<N>>("Gives true where a >= b."));
}
// These are PTX's other names of the unsigned relations: lower, lower or same, higher, higher or same.
template <class N>
constexpr auto unsigned_rows() {
  return joined_rows(
      order_rows<N>(), relation_rows<Relation<".lo", IsLess, 1, 0, 0>, Integer<N>>("Gives true where a < b."),
      relation_rows<Relation<".ls", IsLessOrEqual, 1, 1, 0>, Integer<N>>("Gives true where a <= b."),
      relation_rows<Relation<".hi", IsGreater, 0, 0, 1>, Integer<N>>("Gives true where a > b."),
      relation_rows<Relation<".hs", IsGreaterOrEqual, 0, 1, 1>, Integer<N>>("Gives true where a >= b."));
}

constexpr auto kRows =
    joined_rows(rows_of_types<TypeB16, TypeB32, TypeB64>([]<class N>() { return equality_rows<N>(); }),
                rows_of_types<TypeS16, TypeS32, TypeS64>([]<class N>() { return order_rows<N>(); }),
                rows_of_types<TypeU16, TypeU32, TypeU64>([]<class N>() { return unsigned_rows<N>(); }));

}  // namespace

RowList compare_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
