// Defines the types of conversion rows: bytes in registers of 32 bits, and floats under their PTX names.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <type_traits>

#include "isa/conversions.h"
#include "isa/ops/modifiers.h"
#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {

using TypeS8 = Named<int8_t, ".s8">;
using TypeU8 = Named<uint8_t, ".u8">;

// Names the type of T in a register. A byte fills a register of 32 bits, extended by its sign or by zeros; of
// a source, only the low byte counts.
template <class T>
using Register =
    std::conditional_t<sizeof(T) == 1, std::conditional_t<std::is_signed_v<T>, int32_t, uint32_t>, T>;
template <class T>
constexpr uint64_t register_word(T x) {
  return word(Register<T>(x));
}

// Names the directions of rounding to an integer.
template <Round kRound>
inline constexpr auto integer_round_name = Text(".rni");
template <>
inline constexpr auto integer_round_name<Round::Zero> = Text(".rzi");
template <>
inline constexpr auto integer_round_name<Round::Down> = Text(".rmi");
template <>
inline constexpr auto integer_round_name<Round::Up> = Text(".rpi");

// Makes tables for the four directions, with make.operator()<kRound>() for each.
template <class Make>
constexpr auto rows_of_rounds(Make make) {
  return joined_rows(make.template operator()<Round::Nearest>(), make.template operator()<Round::Zero>(),
                     make.template operator()<Round::Down>(), make.template operator()<Round::Up>());
}

// Describes a float type for conversions: its name, and its exact value as a float or double.
struct TypeF32 : Named<float, ".f32"> {
  static constexpr uint64_t kOne = 0x3f80'0000, kMinusOne = 0xbf80'0000, kTwoAndHalf = 0x4020'0000,
                            kNan = 0x7fc0'0000, kInfinity = 0x7f80'0000;
  [[gnu::always_inline]] static float value(float x) { return x; }
};
struct TypeF64 : Named<double, ".f64"> {
  static constexpr uint64_t kOne = 0x3ff0'0000'0000'0000, kMinusOne = 0xbff0'0000'0000'0000,
                            kTwoAndHalf = 0x4004'0000'0000'0000, kNan = 0x7ff8'0000'0000'0000,
                            kInfinity = 0x7ff0'0000'0000'0000;
  [[gnu::always_inline]] static double value(double x) { return x; }
};
struct TypeF16 : Named<Half, ".f16"> {
  static constexpr uint64_t kOne = 0x3c00, kMinusOne = 0xbc00, kTwoAndHalf = 0x4100, kNan = 0x7e00,
                            kInfinity = 0x7c00;
  [[gnu::always_inline]] static float value(Half x) { return to_float(x); }
};
struct TypeBf16 : Named<Bfloat, ".bf16"> {
  static constexpr uint64_t kOne = 0x3f80, kMinusOne = 0xbf80, kTwoAndHalf = 0x4020, kNan = 0x7fc0,
                            kInfinity = 0x7f80;
  [[gnu::always_inline]] static float value(Bfloat x) { return to_float(x); }
};

}  // namespace glint::isa::GLINT_ISA_PATH
