// Defines the text of a message that a program prints: conversions as in C, each of a 32- or 64-bit value.
// The value of %s is the address of a text in global memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::isa {

inline constexpr uint32_t kMessageWords = 4;  // maximum number of words of one print

// Holds a conversion %[flags][width][.precision][l]letter. `l` means a value of 64 bits: two words, low half
// first.
struct Conversion {
  bool left = false, plus = false, blank = false, alternative = false, zeros = false;  // flags - + blank # 0
  int width = 0;
  int precision = -1;  // -1: none
  bool is_wide = false;
  char letter = 'd';  // one of d i u x X o, f F e E g G a A, c, s
};
inline bool is_float(const Conversion& c) {
  return std::string_view("fFeEgGaA").find(c.letter) != std::string_view::npos;
}
std::string to_text(const Conversion& c);  // such as "%08.3f"

// Reads flags, width and precision after the '%'. Returns where the rest begins.
size_t parse_flags(std::string_view text, size_t at, Conversion& out);
inline constexpr int kMaxMessageWidth = 999;  // limit of width and precision. Choice: it fits a line

struct ParsedMessage {
  struct Piece {
    std::string before;  // text; "%%" is already "%"
    Conversion conversion;
  };
  std::vector<Piece> pieces;
  std::string after;
  uint32_t words = 0;
  std::string error;  // empty: the message is well formed and takes at most kMessageWords
};
ParsedMessage parse_message(std::string_view text);

// Prints as C does in the "C" locale. NaNs and infinities are printed without their payload. `text_at`
// returns the text at an address, for %s.
std::string format_message(const ParsedMessage& message, std::span<const uint32_t> words,
                           const std::function<std::string(uint64_t)>& text_at = {});

}  // namespace glint::isa
