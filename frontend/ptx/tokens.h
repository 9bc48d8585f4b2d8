// Holds PTX text as tokens: words, `.words`, numbers, strings and punctuation, each with its place.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"

namespace glint::frontend::ptx {

// Names a position in the PTX file. Line and column count from 1.
struct TextPosition {
  int line = 0, column = 0;
};

struct Token {
  enum class Kind : uint8_t {
    Word,     // add, %r1, $L__BB0_2, _ZZ6kernel
    DotWord,  // .f32, .entry, .L1::no_allocate: the text has no dot
    Integer,  // in `value`
    Float32,  // 0f3F800000: `value` holds the bits
    Float64,  // 0d3FF0000000000000 or 1.5: `value` holds the bits of the double
    String,
    Mark,  // one character of punctuation, or one of << >> == != <= >= && ||
    End
  } kind = Kind::End;
  std::string text;
  uint64_t value = 0;
  TextPosition position;
};

// Splits `text` and drops comments and line ends. Throws UserError with the position of text that is not a
// token.
std::vector<Token> tokenize(std::string_view text, const std::string& file);

}  // namespace glint::frontend::ptx
