// Defines comparisons of integers.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "isa/ops/comparisons.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr Relation kRelations[] = {
    {".eq", "Gives true where a == b.", Test::Equal, false, 0, 1, 0},
    {".ne", "Gives true where a != b.", Test::Equal, true, 1, 0, 1},
    {".lt", "Gives true where a < b.", Test::Less, false, 1, 0, 0},
    {".le", "Gives true where a <= b.", Test::Greater, true, 1, 1, 0},
    {".gt", "Gives true where a > b.", Test::Greater, false, 0, 0, 1},
    {".ge", "Gives true where a >= b.", Test::Less, true, 0, 1, 1},
    // These are PTX's other names of the unsigned relations: lower, lower or same, higher, higher or same.
    {".lo", "Gives true where a < b.", Test::Less, false, 1, 0, 0},
    {".ls", "Gives true where a <= b.", Test::Greater, true, 1, 1, 0},
    {".hi", "Gives true where a > b.", Test::Greater, false, 0, 0, 1},
    {".hs", "Gives true where a >= b.", Test::Less, true, 0, 1, 1},
};

template <class T>
struct Integer {
  using Type = T;
  [[gnu::always_inline]] static T value(T x) { return x; }
};

// Describes a type, and how many of the relations it has. Equality has no sign.
struct IntegerType {
  size_t num_relations;
  Compared type;
};
template <class N>
constexpr IntegerType integer_type(size_t num_relations) {
  using T = typename N::Type;
  HandlersOfTests handlers_of_tests;
  add_handlers<Integer<std::make_unsigned_t<T>>, Test::Equal>(handlers_of_tests);
  if (num_relations > 2) add_handlers<Integer<T>, Test::Less, Test::Greater>(handlers_of_tests);
  // The examples use two numbers whose order changes when the wrong signedness is taken.
  const uint64_t ones = word(T(-1)), one = 1;
  const bool is_signed = std::is_signed_v<T>;
  return {num_relations,
          {"", joined<N::kName>, Unit::Int, source_kind<T>(), is_signed ? ones : one, is_signed ? one : ones,
           0, handlers_of_tests}};
}
constexpr IntegerType kTypes[] = {
    integer_type<TypeB16>(2),  integer_type<TypeB32>(2),  integer_type<TypeB64>(2),
    integer_type<TypeS16>(6),  integer_type<TypeS32>(6),  integer_type<TypeS64>(6),
    integer_type<TypeU16>(10), integer_type<TypeU32>(10), integer_type<TypeU64>(10),
};

template <class Visit>
constexpr void each_row(Visit&& visit) {
  for (const IntegerType& of : kTypes)
    for (size_t r = 0; r < of.num_relations; ++r) each_row(of.type, kRelations[r], visit);
}
constexpr size_t kNumRows = [] {
  size_t relations = 0;
  for (const IntegerType& of : kTypes) relations += of.num_relations;
  return relations * kRowsOfRelation;
}();
constexpr auto kEachRow = [](auto&& visit) { each_row(visit); };
constexpr auto kNames = names_of<kNumRows>(kEachRow);
constexpr auto kRows = rows_of(kNames, kEachRow);

}  // namespace

RowList compare_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
