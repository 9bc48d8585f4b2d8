// Splits a script into words.
// SPDX-License-Identifier: Apache-2.0
#include "amber/tokens.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#include "amber/type.h"

namespace glint::amber {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

}  // namespace

Token Tokens::next() {
  for (;;) {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    if (at_ >= text_.size()) return {Token::Kind::EndOfText, "", line_};
    if (text_[at_] == '#')
      at_ = std::min(text_.find('\n', at_), text_.size());
    else if (text_[at_] == '\\') {  // This skips up to and including the line end.
      at_ = std::min(text_.find('\n', at_), text_.size());
      if (at_ < text_.size()) ++at_, ++line_;
    } else
      break;
  }
  if (text_[at_] == '\n') return ++at_, Token{Token::Kind::EndOfLine, "", line_++};
  Token token{Token::Kind::Word, "", line_};
  if (text_[at_] == '"') {
    const size_t end = text_.find_first_of("\"\n", at_ + 1);
    if (end == std::string::npos || text_[end] == '\n') throw UserError(here(), "the string has no end");
    token.text = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return token;
  }
  while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n') token.text += text_[at_++];
  return token;
}

Token Tokens::peek() {
  const size_t at = at_;
  const int line = line_;
  Token token = next();
  at_ = at, line_ = line;
  return token;
}

Token Tokens::next_after_line_ends() {
  Token token = next();
  while (token.kind == Token::Kind::EndOfLine) token = next();
  return token;
}

std::string Tokens::word(const char* what) {
  const Token token = peek();
  if (!token.is_word()) throw UserError(here(), fmt::format("{} is missing", what));
  return next().text;
}

bool Tokens::accept(const char* word) {
  if (!peek().is(word)) return false;
  next();
  return true;
}

int64_t Tokens::integer(const char* what, int64_t least, int64_t most) {
  const std::string text = word(what);
  int64_t value = 0;
  if (!parse_integer(text, value) || value < least || value > most)
    throw UserError(here(),
                    fmt::format("{} is '{}', expected an integer from {} to {}", what, text, least, most));
  return value;
}

uint32_t Tokens::number(const char* what) {
  return uint32_t(integer(what, 0, 0xffff'ffff));
}

double Tokens::real(const char* what) {
  const std::string text = word(what);
  double value = 0;
  if (!parse_real(text, value))
    throw UserError(here(), fmt::format("{} is '{}', expected a number", what, text));
  return value;
}

void Tokens::end_line() {
  const Token token = peek();
  if (token.is_word()) throw UserError(here(), fmt::format("'{}' does not belong here", token.text));
  next();
}

std::string Tokens::raw_until_end(int& first_line) {
  end_line();
  first_line = line_;
  const size_t begin = at_;
  while (at_ < text_.size()) {
    const size_t line_begin = at_;
    size_t word = at_;
    while (word < text_.size() && is_blank(text_[word])) ++word;
    const size_t line_end = std::min(text_.find('\n', at_), text_.size());
    const bool is_end = text_.compare(word, 3, "END") == 0 &&
                        (word + 3 >= text_.size() || std::strchr(" \t\r\n#", text_[word + 3]));
    if (is_end) {
      at_ = word + 3;
      return text_.substr(begin, line_begin - begin);
    }
    at_ = std::min(line_end + 1, text_.size());
    ++line_;
  }
  throw UserError({file_, first_line - 1, 0}, "END is missing");
}

}  // namespace glint::amber
