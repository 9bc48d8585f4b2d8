// Writes a field of comma-separated values, and reads one as a number.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace glint::report {

// Appends a field as RFC 4180 writes it: a field with a comma, quote or newline is quoted, and its quotes are
// doubled.
inline void append_csv_field(std::string& out, std::string_view text) {
  const bool is_plain = std::ranges::none_of(text, [](char c) { return c == ',' || c == '"' || c == '\n'; });
  if (is_plain) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) out.append(c == '"' ? 2 : 1, c);
  out += '"';
}

// Returns a field as append_csv_field() writes it.
inline std::string csv_field(std::string_view text) {
  std::string out;
  append_csv_field(out, text);
  return out;
}

// Returns the whole text as a number, or nullopt when it is not a finite number.
inline std::optional<double> finite_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace glint::report
