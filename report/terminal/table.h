// Columns, bars and numbers for a terminal: plain text whose columns line up.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::report {

// What the terminal on stdout can show. The application finds out; a file or pipe has neither.
struct Terminal {
  bool utf8 = false;
  bool colour = false;
};

// Columns a terminal needs for `text`: UTF-8 characters, without escape sequences.
size_t display_width(const std::string& text);

// Rows of cells as aligned columns, each followed by a newline; no spaces at line ends.
// `alignment`: one character a column, '<' or '>'; columns beyond it are '<'.
std::string table(const std::vector<std::vector<std::string>>& rows, const std::string& alignment,
                  const std::string& indent = "");

// A bar of `width` columns filled to `fraction` (clamped to 0..1), in eighths where the terminal can.
std::string bar(double fraction, int width, const Terminal& terminal);

std::string with_thousands(uint64_t value);  // "1 234 567"
std::string percent(double fraction);        // "41.3 %"
std::string seconds(double value);           // "12 ms", "3.4 s", "2 min 05 s", "1 h 02 min"
std::string rate(double per_second);         // "3.42 M", "512 k", "87"

}  // namespace glint::report
