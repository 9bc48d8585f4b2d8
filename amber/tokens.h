// The words of an Amber script, line by line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "base/diagnostics.h"

namespace glint::amber {

struct Token {
  enum class Kind : uint8_t { Word, EndOfLine, EndOfText } kind = Kind::EndOfText;
  std::string text;  // quotes removed
  int line = 0;
  bool is(const char* word) const { return kind == Kind::Word && text == word; }
  bool is_word() const { return kind == Kind::Word; }
};

// A # starts a comment and a \ at the end of a line continues it, but not in the text that raw_until_end()
// takes.
class Tokens {
 public:
  Tokens(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

  Token next();
  Token peek();                        // leaves it there
  Token next_after_line_ends();        // a word, or the end of the text
  std::string word(const char* what);  // UserError when the line ends
  bool accept(const char* word);       // takes it if it is next on the line
  int64_t integer(const char* what, int64_t least, int64_t most);
  uint32_t number(const char* what);  // of 32 bits, not negative
  double real(const char* what);
  void end_line();  // UserError when something is left on the line
  // The lines up to one whose first word is END, which is taken; `first_line` is that of the first.
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
