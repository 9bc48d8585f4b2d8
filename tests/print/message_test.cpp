// Compares formatted messages with those of C's library, and checks which texts are not formats.
// SPDX-License-Identifier: Apache-2.0
#include "isa/message.h"

#include <bit>
#include <cstdio>
#include <random>

#include "tests/support/catch.h"

namespace glint::test {
namespace {

std::string glint_format(const std::string& format, uint64_t bits) {
  const isa::ParsedMessage message = isa::parse_message(format);
  INFO(format);
  REQUIRE(message.error.empty());
  const uint32_t words[4] = {uint32_t(bits), uint32_t(bits >> 32), 0, 0};
  return isa::format_message(message, words);
}

template <class T>
std::string c_format(const std::string& format, T value) {
  char text[4096];
  const int length = std::snprintf(text, sizeof text, format.c_str(), value);
  REQUIRE(length < int(sizeof text));
  return text;
}

std::string random_flags(std::mt19937& random, std::string_view allowed) {
  std::string out = "%";
  for (const char flag : allowed)
    if (random() % 3 == 0) out += flag;
  if (random() % 2) out += std::to_string(1 + random() % 30);
  if (random() % 2) out += "." + std::to_string(random() % 12);
  return out;
}

TEST_CASE("integers of 32 and 64 bits print as C prints them, with every flag") {
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const char letter = "diuxXo"[random() % 6];
    const bool is_signed = letter == 'd' || letter == 'i';
    const std::string start = random_flags(random, is_signed ? "-+ 0" : letter == 'u' ? "-0" : "-#0");
    uint64_t bits = uint64_t{random()} << 32 | random();
    bits >>= random() % 64;
    if (random() % 4 == 0) bits = 0 - bits;
    const std::string narrow = start + letter, wide = start + "l" + letter;
    INFO(narrow << " of " << bits);
    CHECK(glint_format(narrow, uint32_t(bits)) == c_format(narrow, uint32_t(bits)));
    CHECK(glint_format(wide, bits) == c_format(wide, bits));
  }
}

TEST_CASE("floats and doubles print as C prints them, with every flag") {
  std::mt19937 random(2);
  for (int i = 0; i < 20'000; ++i) {
    const char letter = "fFeEgGaA"[random() % 8];
    const std::string start = random_flags(random, "-+ 0");
    // The exponents are moderate, except that every eighth time all bits are random. NaNs are left out,
    // because their sign may differ.
    uint64_t bits = (uint64_t{random()} << 32 | random()) & 0x800f'ffff'ffff'ffff;
    bits |= uint64_t{1023 - 40 + random() % 80} << 52;
    if (random() % 8 == 0) bits = uint64_t{random()} << 32 | random();
    const double value = std::bit_cast<double>(bits);
    const float single = float(value);
    if (value != value || single != single) continue;
    INFO(start << letter << " of " << value);
    CHECK(glint_format(start + "l" + letter, bits) == c_format(start + letter, value));
    CHECK(glint_format(start + letter, std::bit_cast<uint32_t>(single)) ==
          c_format(start + letter, double(single)));
  }
  for (const uint32_t special : {0u, 0x8000'0000u, 0x7f80'0000u, 0xff80'0000u, 0x7fc0'0000u, 1u})
    for (const char* format : {"%f", "%8.3e", "%-9G|", "%+a", "%010f", "%x"})
      if (std::string(format) != "%x")
        CHECK(glint_format(format, special) == c_format(format, double(std::bit_cast<float>(special))));
}

TEST_CASE("a message takes several values, and percent signs stand for themselves when doubled") {
  const uint32_t words[4] = {7, std::bit_cast<uint32_t>(0.5f), 1, 2};
  const isa::ParsedMessage message = isa::parse_message("100%% a=%d b=%.2f c=%lx%%\n");
  REQUIRE(message.error.empty());
  CHECK(message.words == 4);
  CHECK(isa::format_message(message, words) == "100% a=7 b=0.50 c=200000001%\n");
}

TEST_CASE("a message takes characters, and texts from where their addresses point") {
  const uint32_t words[3] = {'x', 7, 1};
  const isa::ParsedMessage message = isa::parse_message("<%c%3c|%-6ls|%.2ls>");
  CHECK(message.error == "the message has 6 words, but a print takes 4");
  const isa::ParsedMessage shorter = isa::parse_message("<%3c|%-6ls>");
  REQUIRE(shorter.error.empty());
  const auto text = [](uint64_t address) {
    return address == 0x1'0000'0007 ? std::string("abc") : std::string();
  };
  CHECK(isa::format_message(shorter, words, text) == "<  x|abc   >");
}

TEST_CASE("text that is not a conversion, is too wide or takes too many words is an error") {
  for (const char* bad : {"%", "abc %", "%s", "%lc", "%5", "%.", "%-", "%l", "%ld%ld%d", "%1000d", "%.1000f",
                          "%99999999999d", "%d%d%d%d%d", "%y"}) {
    INFO(bad);
    CHECK(!isa::parse_message(bad).error.empty());
  }
  CHECK(isa::parse_message("%ld%ld").error.empty());
}

}  // namespace
}  // namespace glint::test
