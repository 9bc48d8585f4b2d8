// The text of a message that a program prints: conversions as in C, each of a 32- or 64-bit value.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::isa {

inline constexpr uint32_t kMessageWords = 4;  // that one print takes

// %[flags][width][.precision][l]letter. `l`: the value has 64 bits, two words, low half first.
struct Conversion {
  bool left = false, plus = false, blank = false, alternative = false, zeros = false;  // flags - + blank # 0
  int width = 0;
  int precision = -1;  // none
  bool is_wide = false;
  char letter = 'd';  // of d i u x X o, f F e E g G a A
};
inline bool is_float(const Conversion& c) {
  return std::string_view("fFeEgGaA").find(c.letter) != std::string_view::npos;
}
std::string to_text(const Conversion& c);  // "%08.3f"

// Reads flags, width and precision, from behind the '%'; returns where the rest begins.
size_t parse_flags(std::string_view text, size_t at, Conversion& out);
inline constexpr int kMaxMessageWidth = 999;  // of width and precision. Choice: what a line may hold

struct ParsedMessage {
  struct Piece {
    std::string before;  // text, "%%" already being "%"
    Conversion conversion;
  };
  std::vector<Piece> pieces;
  std::string after;
  uint32_t words = 0;
  std::string error;  // empty: it is well formed and takes at most kMessageWords
};
ParsedMessage parse_message(std::string_view text);

// As C prints in the "C" locale; NaNs and infinities without regard to payload.
std::string format_message(const ParsedMessage& message, std::span<const uint32_t> words);

}  // namespace glint::isa
