// Lays out text for terminals.
// SPDX-License-Identifier: Apache-2.0
#include "report/terminal/table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace glint::report {

size_t display_width(const std::string& text) {
  size_t width = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\x1b') {  // The sequence is "ESC [ ... m".
      while (i < text.size() && text[i] != 'm') ++i;
      continue;
    }
    if ((uint8_t(text[i]) & 0xc0) != 0x80) ++width;  // Continuation bytes take no column.
  }
  return width;
}

std::string table(const std::vector<std::vector<std::string>>& rows, const std::string& alignment,
                  const std::string& indent) {
  std::vector<size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], display_width(row[i]));
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line = indent;
    for (size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - display_width(row[i]), ' ');
      const bool right = i < alignment.size() && alignment[i] == '>';
      if (i > 0) line += "  ";
      line += right ? padding + row[i] : row[i] + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::string bar(double fraction, int width, const Terminal& terminal) {
  const double clamped = std::isnan(fraction) ? 0.0 : std::clamp(fraction, 0.0, 1.0);
  std::string out;
  if (!terminal.utf8) {
    const int full = int(std::lround(clamped * width));
    return std::string(size_t(full), '#') + std::string(size_t(width - full), '.');
  }
  static constexpr const char* kEighths[] = {" ", "▏", "▎", "▍", "▌", "▋", "▊", "▉", "█"};
  const int eighths = int(std::lround(clamped * width * 8));
  for (int i = 0; i < width; ++i) out += kEighths[std::clamp(eighths - i * 8, 0, 8)];
  return out;
}

std::string with_thousands(uint64_t value) {
  std::string text = fmt::format("{}", value);
  for (size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, " ");
  return text;
}

std::string percent(double fraction) {
  return fmt::format("{:.1f} %", fraction * 100);
}

std::string seconds(double value) {
  if (value < 0.9995) return fmt::format("{:.0f} ms", value * 1000);
  if (value < 59.95) return fmt::format("{:.1f} s", value);
  const auto whole = uint64_t(std::llround(value));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string rate(double per_second) {
  if (per_second >= 999.5e6) return fmt::format("{:.2f} G", per_second / 1e9);
  if (per_second >= 999.5e3) return fmt::format("{:.2f} M", per_second / 1e6);
  if (per_second >= 999.5) return fmt::format("{:.0f} k", per_second / 1e3);
  return fmt::format("{:.0f}", per_second);
}

}  // namespace glint::report
