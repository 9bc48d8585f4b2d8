// Splits program text into tokens, each with its place. Only the parser uses it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cctype>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <string_view>

#include "base/diagnostics.h"

namespace glint::isa {

struct Token {
  enum class Kind : uint8_t { Word, String, Punctuation, Newline, End } kind = Kind::End;
  std::string text;
  int line = 1, column = 1;
};

class Tokens {
 public:
  Tokens(const std::string& text, const std::string& file) : text_(text), file_(file) { advance(); }

  const Token& peek() const { return token_; }
  Token take() {
    Token taken = token_;
    advance();
    return taken;
  }
  void skip_newlines() {
    while (token_.kind == Token::Kind::Newline) advance();
  }
  bool take_if(std::string_view punctuation) {
    if (token_.kind != Token::Kind::Punctuation || token_.text != punctuation) return false;
    advance();
    return true;
  }
  void expect(std::string_view punctuation, std::string_view where) {
    if (!take_if(punctuation)) fail(token_, fmt::format("'{}' {}", punctuation, where));
  }
  std::string take_word(std::string_view what) {
    if (token_.kind != Token::Kind::Word) fail(token_, what);
    return take().text;
  }
  [[noreturn]] void fail(const Token& at, std::string_view expected, const std::string& note = {}) const {
    const std::string found = at.kind == Token::Kind::End       ? "the end of the file"
                              : at.kind == Token::Kind::Newline ? "the end of the line"
                                                                : "'" + at.text + "'";
    throw UserError({file_, at.line, at.column}, fmt::format("found {}, expected {}", found, expected), note);
  }

 private:
  static bool is_word(char c) {
    return std::isalnum(uint8_t(c)) || c == '_' || c == '.' || c == '%' || c == '$';
  }

  // Returns whether this is the '-' of "2e-3": it follows the 'e' of a word that is a decimal number so far.
  bool is_exponent_sign() const {
    const std::string& word = token_.text;
    return (next() == '-' || next() == '+') && word.size() >= 2 &&
           (word.back() == 'e' || word.back() == 'E') &&
           word.find_first_not_of("0123456789.") == word.size() - 1;
  }
  char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void step() {
    if (text_[at_++] == '\n') {
      ++line_;
      column_ = 1;
    } else {
      ++column_;
    }
  }
  void skip_blanks() {
    while (at_ < text_.size()) {
      if (next() == '/' && at_ + 1 < text_.size() && text_[at_ + 1] == '/')
        while (at_ < text_.size() && next() != '\n') step();
      else if (next() == ' ' || next() == '\t' || next() == '\r')
        step();
      else
        return;
    }
  }
  void advance() {
    skip_blanks();
    token_ = {Token::Kind::End, "", line_, column_};
    if (at_ >= text_.size()) return;
    const char c = next();
    if (c == '\n') {
      token_.kind = Token::Kind::Newline;
      step();
    } else if (c == '"') {
      read_string();
    } else if (is_word(c)) {
      token_.kind = Token::Kind::Word;
      for (; at_ < text_.size() && (is_word(next()) || is_exponent_sign()); step()) token_.text += next();
    } else {
      token_.kind = Token::Kind::Punctuation;
      token_.text = c;
      step();
    }
  }
  void read_string() {
    token_.kind = Token::Kind::String;
    step();
    for (; at_ < text_.size() && next() != '"' && next() != '\n'; step()) {
      char c = next();
      if (c == '\\') {
        step();
        c = next() == 'n' ? '\n' : next();
      }
      if (at_ >= text_.size()) break;
      token_.text += c;
    }
    if (next() != '"') fail(token_, "a closing '\"'");
    step();
  }

  const std::string& text_;
  const std::string& file_;
  size_t at_ = 0;
  int line_ = 1, column_ = 1;
  Token token_;
};

}  // namespace glint::isa
