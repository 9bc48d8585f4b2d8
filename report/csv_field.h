// A field of comma-separated values.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace glint::report {

// RFC 4180: a field with a comma, quote or newline is quoted, its quotes doubled.
inline std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace glint::report
