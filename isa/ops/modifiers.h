// Defines modifiers of floating-point ops: their spelling and their words, and the rows of all their
// combinations.
// SPDX-License-Identifier: Apache-2.0
//
// Only files of isa/ops include this file (see op_makers.h).
#pragma once
#include <array>
#include <utility>

#include "isa/ops/row_tables.h"
#include "isa/rounding.h"

namespace glint::isa::GLINT_ISA_PATH {

// Says how one member of a family of ops rounds and what else it does. Examples depend on it.
struct Mode {
  Round round = Round::Nearest;
  bool ftz = false;
  bool sat = false;
  bool relu = false;
};

// Gives the text where the modifier is on, and nothing where it is off.
template <bool kOn, Text kText>
inline constexpr auto when = kText;
template <Text kText>
inline constexpr auto when<false, kText> = Text("");

template <Round kRound>
inline constexpr auto round_name = Text(".rn");
template <>
inline constexpr auto round_name<Round::Zero> = Text(".rz");
template <>
inline constexpr auto round_name<Round::Down> = Text(".rm");
template <>
inline constexpr auto round_name<Round::Up> = Text(".rp");

template <Round kRound>
inline constexpr auto round_words = Text(", and rounds the result to nearest even");
template <>
inline constexpr auto round_words<Round::Zero> = Text(", and rounds the result toward zero");
template <>
inline constexpr auto round_words<Round::Down> = Text(", and rounds the result down");
template <>
inline constexpr auto round_words<Round::Up> = Text(", and rounds the result up");

inline constexpr Text kFtzWords = ". Subnormal sources and results become zero";
inline constexpr Text kSatWords = ". The result is clamped to [0, 1], and NaN becomes 0";
inline constexpr Text kReluWords = ". Negative results become 0";

// Lists the directions in PTX's order.
inline constexpr Round kRounds[] = {Round::Nearest, Round::Zero, Round::Down, Round::Up};

// Makes `kCount` rows with `row(i)`, where each i is a compile-time constant.
template <size_t kCount, class Row>
constexpr auto generated(Row row) {
  return [&]<size_t... I>(std::index_sequence<I...>) {
    return std::array<OpRow, kCount>{row(std::integral_constant<size_t, I>{})...};
  }
  (std::make_index_sequence<kCount>{});
}

}  // namespace glint::isa::GLINT_ISA_PATH
