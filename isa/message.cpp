// Reads and fills in the formats of messages.
// SPDX-License-Identifier: Apache-2.0
#include "isa/message.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdio>
#include <fmt/format.h>
#include <utility>

namespace glint::isa {
namespace {

// Reads a decimal number at `at`, which is at most kMaxMessageWidth + 1.
int number_at(std::string_view text, size_t& at) {
  int value = 0;
  for (; at < text.size() && std::isdigit(uint8_t(text[at])); ++at)
    value = std::min(value * 10 + (text[at] - '0'), kMaxMessageWidth + 1);
  return value;
}

std::string padded(const Conversion& c, const std::string& sign, const std::string& digits, bool zeros) {
  const size_t length = sign.size() + digits.size(), width = size_t(c.width);
  if (length >= width) return sign + digits;
  const size_t fill = width - length;
  if (c.left) return sign + digits + std::string(fill, ' ');
  return zeros ? sign + std::string(fill, '0') + digits : std::string(fill, ' ') + sign + digits;
}

std::string sign_of(const Conversion& c, bool negative) {
  return negative ? "-" : c.plus ? "+" : c.blank ? " " : "";
}

std::string format_integer(const Conversion& c, uint64_t bits) {
  const bool is_signed = c.letter == 'd' || c.letter == 'i';
  const int64_t value = c.is_wide ? int64_t(bits) : int64_t(int32_t(uint32_t(bits)));
  const bool negative = is_signed && value < 0;
  const uint64_t magnitude = negative ? 0 - uint64_t(value) : bits;
  std::string digits = c.letter == 'x'   ? fmt::format("{:x}", magnitude)
                       : c.letter == 'X' ? fmt::format("{:X}", magnitude)
                       : c.letter == 'o' ? fmt::format("{:o}", magnitude)
                                         : fmt::format("{}", magnitude);
  if (c.precision == 0 && magnitude == 0) digits.clear();
  if (c.precision > int(digits.size())) digits.insert(0, size_t(c.precision) - digits.size(), '0');
  if (c.alternative && c.letter == 'o' && (digits.empty() || digits[0] != '0')) digits.insert(0, "0");
  std::string sign = is_signed ? sign_of(c, negative) : "";
  if (c.alternative && magnitude != 0 && (c.letter == 'x' || c.letter == 'X'))
    sign = std::string("0") + c.letter;
  return padded(c, sign, digits, c.zeros && c.precision < 0);
}

// Writes a number in C's hexadecimal form, by the C library: versions of fmt differ in the exponent of 0 and
// in the rounding of ties.
std::string hexadecimal(const Conversion& c, double value) {
  const std::string format = std::string(c.alternative ? "%#" : "%") +
                             (c.precision >= 0 ? fmt::format(".{}", c.precision) : "") + c.letter;
  std::string out(size_t(std::snprintf(nullptr, 0, format.c_str(), value)) + 1, ' ');
  std::snprintf(out.data(), out.size(), format.c_str(), value);
  out.pop_back();  // the zero byte
  return out;
}

std::string format_float(const Conversion& c, uint64_t bits) {
  const double value = c.is_wide ? std::bit_cast<double>(bits) : double(std::bit_cast<float>(uint32_t(bits)));
  const bool is_number = value == value && value - value == 0;
  const bool negative = std::bit_cast<uint64_t>(value) >> 63 != 0 && value == value;
  const bool is_hexadecimal = c.letter == 'a' || c.letter == 'A';
  const std::string format =  // C's default precision is 6
      fmt::format("{{:{}.{}", c.alternative ? "#" : "", c.precision >= 0 ? c.precision : 6);
  const double magnitude = std::bit_cast<double>(std::bit_cast<uint64_t>(value) & ~(uint64_t{1} << 63));
  const std::string digits = is_hexadecimal ? hexadecimal(c, magnitude)
                                            : fmt::format(fmt::runtime(format + c.letter + "}"), magnitude);
  if (!is_number || !is_hexadecimal) return padded(c, sign_of(c, negative), digits, c.zeros && is_number);
  // The zeros come after 0x.
  return padded(c, sign_of(c, negative) + digits.substr(0, 2), digits.substr(2), c.zeros);
}

std::string format_text(const Conversion& c, const std::string& text) {
  return padded(c, "", c.precision >= 0 ? text.substr(0, size_t(c.precision)) : text, false);
}

}  // namespace

size_t parse_flags(std::string_view text, size_t at, Conversion& out) {
  for (; at < text.size(); ++at) {
    const char flag = text[at];
    if (flag == '-')
      out.left = true;
    else if (flag == '+')
      out.plus = true;
    else if (flag == ' ')
      out.blank = true;
    else if (flag == '#')
      out.alternative = true;
    else if (flag == '0')
      out.zeros = true;
    else
      break;
  }
  out.width = number_at(text, at);
  if (at < text.size() && text[at] == '.') out.precision = number_at(text, ++at);
  return at;
}

std::string to_text(const Conversion& c) {
  std::string out = "%";
  for (const auto& [is_set, flag] :
       {std::pair{c.left, '-'}, {c.plus, '+'}, {c.blank, ' '}, {c.alternative, '#'}, {c.zeros, '0'}})
    if (is_set) out += flag;
  if (c.width > 0) out += std::to_string(c.width);
  if (c.precision >= 0) out += "." + std::to_string(c.precision);
  return out + (c.is_wide ? "l" : "") + c.letter;
}

ParsedMessage parse_message(std::string_view text) {
  ParsedMessage out;
  const auto wrong = [&](const std::string& what) {
    out.error = what;
    return out;
  };
  std::string before;
  for (size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '%') {
      before += text[at];
      continue;
    }
    if (at + 1 < text.size() && text[at + 1] == '%') {
      before += text[++at];
      continue;
    }
    ParsedMessage::Piece piece;
    const size_t first = at;
    at = parse_flags(text, at + 1, piece.conversion);
    if (at < text.size() && text[at] == 'l') piece.conversion.is_wide = true, ++at;
    piece.conversion.letter = at < text.size() ? text[at] : '\0';
    const char letter = piece.conversion.letter;
    const bool is_known = std::string_view("diuxXofFeEgGaAcs").find(letter) != std::string_view::npos;
    // An address has 64 bits, and a character has not.
    if (letter == '\0' || !is_known || (letter == 's') > piece.conversion.is_wide ||
        (letter == 'c' && piece.conversion.is_wide))
      return wrong(fmt::format("'{}' is not a conversion", text.substr(first, at + 1 - first)));
    if (std::max(piece.conversion.width, piece.conversion.precision) > kMaxMessageWidth)
      return wrong(fmt::format("the width is more than {}", kMaxMessageWidth));
    piece.before = std::move(before);
    before.clear();
    out.words += piece.conversion.is_wide ? 2 : 1;
    out.pieces.push_back(std::move(piece));
  }
  out.after = std::move(before);
  if (out.words > kMessageWords)
    return wrong(fmt::format("the message has {} words, but a print takes {}", out.words, kMessageWords));
  return out;
}

std::string format_message(const ParsedMessage& message, std::span<const uint32_t> words,
                           const std::function<std::string(uint64_t)>& text_at) {
  std::string out;
  size_t word = 0;
  for (const ParsedMessage::Piece& piece : message.pieces) {
    const Conversion& c = piece.conversion;
    const uint64_t low = words[word], bits = c.is_wide ? low | uint64_t{words[word + 1]} << 32 : low;
    word += c.is_wide ? 2 : 1;
    out += piece.before + (is_float(c)       ? format_float(c, bits)
                           : c.letter == 'c' ? format_text(c, std::string(1, char(bits)))
                           : c.letter == 's' ? format_text(c, text_at ? text_at(bits) : std::string())
                                             : format_integer(c, bits));
  }
  return out + message.after;
}

}  // namespace glint::isa
