// Holds the words of an Amber script, line by line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "base/diagnostics.h"

namespace glint::amber {

struct Token {
  enum class Kind : uint8_t { Word, EndOfLine, EndOfText } kind = Kind::EndOfText;
  std::string text;  // without quotes
  int line = 0;
  bool is(const char* word) const { return kind == Kind::Word && text == word; }
  bool is_word() const { return kind == Kind::Word; }
};

// Splits text into words. A # starts a comment, and a \ at the end of a line continues the line; neither
// holds in the text that raw_until_end() takes.
class Tokens {
 public:
  Tokens(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

  Token next();
  Token peek();                        // does not take the token
  Token next_after_line_ends();        // a word, or the end of the text
  std::string word(const char* what);  // throws UserError when the line ends
  bool accept(const char* word);       // takes the word if it is the next on the line
  int64_t integer(const char* what, int64_t least, int64_t most);
  uint32_t number(const char* what);  // from 0 to the largest of 32 bits
  double real(const char* what);
  void end_line();  // throws UserError when something is left on the line
  // Returns the lines up to one whose first word is END, which is taken too. `first_line` becomes the number
  // of the first returned line.
  std::string raw_until_end(int& first_line);

  int line() const { return line_; }
  SourceLocation here() const { return {file_, line_, 0}; }
  const std::string& file() const { return file_; }

 private:
  const std::string text_, file_;
  size_t at_ = 0;
  int line_ = 1;
};

}  // namespace glint::amber
