// Defines what a literal in program text means in an operand slot. Printer and parser share it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "isa/op_row.h"

namespace glint::isa {

// Returns whether a literal in slot `slot` of `row` is a float. The op's last type decides, except for ops
// that mix types, which are listed here. Bits printed as a float are the same bits; only a decimal fraction
// needs this knowledge.
inline bool is_float(const OpRow& row, int slot) {
  if (row.effect == Effect::Trace) return slot >= 7 && slot <= 14;  // origin, tmin, direction, tmax
  if (row.effect == Effect::Report) return slot == 1;
  // These slots are the results and the handle.
  if (row.effect == Effect::Texture && slot <= slots_of(row.operands.kind[0])) return false;
  return row.name.ends_with(".f32") || row.name.ends_with(".f64");
}

// Returns the number that `text` writes in `base`, if the whole text is digits and the number fits 64 bits.
inline std::optional<uint64_t> digits(std::string_view text, unsigned base) {
  if (text.empty()) return {};
  uint64_t value = 0;
  for (const char c : text) {
    const unsigned d = c >= '0' && c <= '9'   ? unsigned(c - '0')
                       : c >= 'a' && c <= 'f' ? unsigned(c - 'a') + 10
                       : c >= 'A' && c <= 'F' ? unsigned(c - 'A') + 10
                                              : 99;
    if (d >= base || value > (std::numeric_limits<uint64_t>::max() - d) / base) return {};
    value = value * base + d;
  }
  return value;
}

// Reads "17", "0x11", "0f3F800000" (8 digits) or "0d3FF0000000000000" (16 digits).
inline std::optional<uint64_t> number(std::string_view text) {
  const std::string_view head = text.substr(0, 2),
                         rest = text.size() > 2 ? text.substr(2) : std::string_view();
  if (head == "0x" || head == "0X") return digits(rest, 16);
  if (head == "0f" || head == "0F") return rest.size() == 8 ? digits(rest, 16) : std::nullopt;
  if (head == "0d" || head == "0D") return rest.size() == 16 ? digits(rest, 16) : std::nullopt;
  return digits(text, 10);
}

// Returns for "1.5" or "2e-3" the bits of the nearest float of 32 or 64 bits, and nothing for a text with
// neither point nor exponent.
inline std::optional<uint64_t> fraction(std::string_view text, bool is_wide) {
  if (text.empty() || text[0] < '0' || text[0] > '9') return {};
  if (text.find_first_of(".eE") == std::string_view::npos) return {};
  const char* const end = text.data() + text.size();
  double wide = 0;
  float narrow = 0;
  const auto result =
      is_wide ? std::from_chars(text.data(), end, wide) : std::from_chars(text.data(), end, narrow);
  if (result.ptr != end || result.ec != std::errc()) return {};
  return is_wide ? std::bit_cast<uint64_t>(wide) : std::bit_cast<uint32_t>(narrow);
}

}  // namespace glint::isa
