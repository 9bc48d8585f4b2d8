// Lays out columns, bars and numbers for a terminal, as plain text whose columns line up.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::report {

// Says what the terminal on stdout can show, which the application finds out. A file or pipe can show
// neither.
struct Terminal {
  bool utf8 = false;
  bool colour = false;
};

// Returns the columns that a terminal needs for `text`: its UTF-8 characters, without escape sequences.
size_t display_width(const std::string& text);

// Returns rows of cells as aligned columns, each followed by a newline, without spaces at line ends.
// `alignment` has one character per column, '<' or '>'; columns beyond it are '<'.
std::string table(const std::vector<std::vector<std::string>>& rows, const std::string& alignment,
                  const std::string& indent = "");

// Returns a bar of `width` columns, filled to `fraction` (clamped to 0 to 1), in eighths where the terminal
// can show them.
std::string bar(double fraction, int width, const Terminal& terminal);

std::string with_thousands(uint64_t value);  // such as "1 234 567"
std::string percent(double fraction);        // such as "41.3 %"
// Returns `of` / `whole`, or 0 where the whole is 0.
inline double part(uint64_t of, uint64_t whole) {
  return whole ? double(of) / double(whole) : 0.0;
}
std::string seconds(double value);    // such as "12 ms", "3.4 s", "2 min 05 s", "1 h 02 min"
std::string rate(double per_second);  // such as "3.42 M", "512 k", "87"

}  // namespace glint::report
