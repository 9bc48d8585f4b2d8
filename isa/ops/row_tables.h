// Makes tables of op rows from lists: of types, of modifiers, of other tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <type_traits>

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

// Names an operand type as PTX does: b32 and u32 are both uint32_t.
template <class T, Text kText>
struct Named {
  using Type = T;
  static constexpr auto kName = kText;
};
using TypeS16 = Named<int16_t, ".s16">;
using TypeU16 = Named<uint16_t, ".u16">;
using TypeB16 = Named<uint16_t, ".b16">;
using TypeS32 = Named<int32_t, ".s32">;
using TypeU32 = Named<uint32_t, ".u32">;
using TypeB32 = Named<uint32_t, ".b32">;
using TypeS64 = Named<int64_t, ".s64">;
using TypeU64 = Named<uint64_t, ".u64">;
using TypeB64 = Named<uint64_t, ".b64">;

// Returns a value as an example writes it: its bits, with zeros above.
template <class T>
constexpr uint64_t word(T x) {
  if constexpr (sizeof(T) == 8)
    return __builtin_bit_cast(uint64_t, x);
  else if constexpr (sizeof(T) == 4)
    return __builtin_bit_cast(uint32_t, x);
  else
    return __builtin_bit_cast(uint16_t, x);
}

template <size_t kSize>
constexpr size_t rows_in(const std::array<OpRow, kSize>*) {
  return kSize;
}
constexpr size_t rows_in(const OpRow*) {
  return 1;
}

// Joins rows and tables to one table, in their order.
template <class... Part>
constexpr auto joined_rows(const Part&... parts) {
  std::array<OpRow, (rows_in(static_cast<const Part*>(nullptr)) + ... + 0)> out{};
  size_t n = 0;
  const auto append = [&]<class P>(const P& part) {
    if constexpr (std::is_same_v<P, OpRow>)
      out[n++] = part;
    else
      for (const OpRow& row : part) out[n++] = row;
  };
  (append(parts), ...);
  return out;
}

// Joins the rows (or tables) that `make.operator()<N>()` gives for each N of a list of types.
template <class... N, class Make>
constexpr auto rows_of_types(Make make) {
  return joined_rows(make.template operator()<N>()...);
}

// Does the same as rows_of_types() for a list of names: modifiers, comparisons.
template <Text... kNames, class Make>
constexpr auto rows_of_names(Make make) {
  return joined_rows(make.template operator()<kNames>()...);
}

}  // namespace glint::isa::GLINT_ISA_PATH
