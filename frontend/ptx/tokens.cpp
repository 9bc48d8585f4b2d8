// Splits PTX text into tokens.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/tokens.h"

#include <bit>
#include <cctype>
#include <cstdlib>
#include <fmt/format.h>
#include <utility>

namespace glint::frontend::ptx {
namespace {

bool is_word_start(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) || c == '_' || c == '$' || c == '%';
}
bool is_word_part(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '$';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

class Tokenizer {
 public:
  Tokenizer(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::vector<Token> run() {
    while (true) {
      skip_space();
      Token token;
      token.position = position_;
      if (at_ == text_.size()) {
        tokens_.push_back(token);
        return std::move(tokens_);
      }
      const char c = text_[at_];
      if (is_word_start(c)) {
        // `%` alone is the remainder operator of constant expressions.
        token.kind = c == '%' && !is_word_part(peek(1)) ? Token::Kind::Mark : Token::Kind::Word;
        token.text = take(
            [&, first = true](char x) mutable { return std::exchange(first, false) || is_word_part(x); });
      } else if (c == '.' && is_word_part(peek(1)) && !(is_digit(peek(1)) && !glues())) {
        token.kind = Token::Kind::DotWord;
        advance();
        token.text = take([&](char x) { return is_word_part(x) || x == ':'; });
      } else if (is_digit(c)) {
        number(token);
      } else if (c == '"') {
        string(token);
      } else {
        mark(token);
      }
      tokens_.push_back(std::move(token));
    }
  }

 private:
  char peek(size_t ahead) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  // Returns whether a word stands directly before the dot. Then `.2d` is a modifier of the word; otherwise
  // `.5` would be a number.
  bool glues() const { return at_ > 0 && (is_word_part(text_[at_ - 1])); }

  void advance() {
    if (text_[at_++] == '\n') {
      ++position_.line;
      position_.column = 1;
    } else {
      ++position_.column;
    }
  }
  template <class Test>
  std::string take(Test&& test) {
    const size_t begin = at_;
    while (at_ < text_.size() && test(text_[at_])) advance();
    return std::string(text_.substr(begin, at_ - begin));
  }
  [[noreturn]] void fail(TextPosition at, const std::string& what) const {
    throw UserError({file_, at.line, at.column}, what);
  }

  void skip_space() {
    while (at_ < text_.size()) {
      if (std::isspace(static_cast<unsigned char>(text_[at_]))) {
        advance();
      } else if (text_.substr(at_, 2) == "//") {
        while (at_ < text_.size() && text_[at_] != '\n') advance();
      } else if (text_.substr(at_, 2) == "/*") {
        const TextPosition begin = position_;
        while (at_ < text_.size() && text_.substr(at_, 2) != "*/") advance();
        if (at_ == text_.size()) fail(begin, "this comment has no end");
        advance();
        advance();
      } else {
        return;
      }
    }
  }

  void number(Token& token) {
    const char kind = char(std::tolower(static_cast<unsigned char>(peek(1))));
    if (text_[at_] == '0' && (kind == 'f' || kind == 'd')) {
      token.text = take(is_word_part);
      const size_t digits = kind == 'f' ? 8 : 16;
      token.kind = kind == 'f' ? Token::Kind::Float32 : Token::Kind::Float64;
      token.value = digits_of(token, 2, 16);
      if (token.text.size() != 2 + digits)
        fail(token.position, fmt::format("'{}' has {} digits, but 0{} takes {}", token.text,
                                         token.text.size() - 2, kind, digits));
      return;
    }
    if (text_[at_] == '0' && (kind == 'x' || kind == 'b')) {
      token.text = take(is_word_part);
      token.kind = Token::Kind::Integer;
      token.value = digits_of(token, 2, kind == 'x' ? 16 : 2);
      return;
    }
    bool is_float = false;
    char last = '\0';
    token.text = take([&](char c) {
      const bool exponent_sign = (c == '+' || c == '-') && (last == 'e' || last == 'E');
      const bool part = is_digit(c) || c == '.' || c == 'e' || c == 'E' || exponent_sign || c == 'U';
      is_float |= part && !is_digit(c) && c != 'U';
      last = c;
      return part;
    });
    if (is_float) {
      char* end = nullptr;
      token.kind = Token::Kind::Float64;
      token.value = std::bit_cast<uint64_t>(std::strtod(token.text.c_str(), &end));
      if (*end != '\0') fail(token.position, fmt::format("'{}' is not a number", token.text));
    } else {
      token.kind = Token::Kind::Integer;
      const bool octal = token.text.size() > 1 && token.text[0] == '0';
      token.value = digits_of(token, 0, octal ? 8 : 10);
    }
  }

  uint64_t digits_of(const Token& token, size_t from, int base) const {
    const std::string digits = token.text.substr(from, token.text.size() - from - (token.text.back() == 'U'));
    char* end = nullptr;
    const uint64_t value = std::strtoull(digits.c_str(), &end, base);
    if (digits.empty() || *end != '\0') fail(token.position, fmt::format("'{}' is not a number", token.text));
    return value;
  }

  void string(Token& token) {
    token.kind = Token::Kind::String;
    advance();
    token.text = take([&](char c) { return c != '"'; });
    if (at_ == text_.size()) fail(token.position, "this string has no end");
    advance();
  }

  void mark(Token& token) {
    token.kind = Token::Kind::Mark;
    for (std::string_view two : {"<<", ">>", "==", "!=", "<=", ">=", "&&", "||"})
      if (text_.substr(at_, 2) == two) token.text = two;
    if (token.text.empty()) token.text = std::string(1, text_[at_]);
    if (token.text.size() == 1 &&
        std::string_view("!&()*+,-/:;<=>?@[]^{|}~%").find(text_[at_]) == std::string_view::npos)
      fail(token.position, fmt::format("unexpected character '{}'", text_[at_]));
    for (size_t i = 0; i < token.text.size(); ++i) advance();
  }

  const std::string_view text_;
  const std::string& file_;
  size_t at_ = 0;
  TextPosition position_{1, 1};
  std::vector<Token> tokens_;
};

}  // namespace

std::vector<Token> tokenize(std::string_view text, const std::string& file) {
  return Tokenizer(text, file).run();
}

}  // namespace glint::frontend::ptx
