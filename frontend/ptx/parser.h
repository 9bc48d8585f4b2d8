// Declares the tools that the parsers of declarations and statements share: a cursor over tokens, constant
// expressions, operands.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frontend/ptx/syntax.h"

namespace glint::frontend::ptx {

class Cursor {
 public:
  Cursor(std::vector<Token> tokens, std::string file) : tokens_(std::move(tokens)), file_(std::move(file)) {}

  const Token& peek(size_t ahead = 0) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }
  const Token& next() { return tokens_[at_ + 1 < tokens_.size() ? at_++ : at_]; }
  bool at_end() const { return peek().kind == Token::Kind::End; }
  bool is_mark(std::string_view text) const {
    return peek().kind == Token::Kind::Mark && peek().text == text;
  }
  bool is_dot(std::string_view text) const {
    return peek().kind == Token::Kind::DotWord && peek().text == text;
  }
  bool is(Token::Kind kind) const { return peek().kind == kind; }
  bool accept(std::string_view mark);      // takes the mark if it is next
  bool accept_dot(std::string_view word);  // takes the `.word` if it is next
  void expect(std::string_view mark);
  std::string expect_word(const std::string& what);
  uint64_t expect_integer(const std::string& what) { return constant(what); }

  // Reads a constant expression of integers. Operators have the precedence of C.
  uint64_t constant(const std::string& what) { return binary(0, what); }
  // Reads an operand of an instruction.
  Operand operand();

  [[noreturn]] void fail(const std::string& expected) const;  // throws "expected X, found Y" at this place
  [[noreturn]] void fail(TextPosition at, const std::string& message) const;

 private:
  uint64_t binary(int least, const std::string& what);
  uint64_t unary(const std::string& what);
  Operand simple_operand();
  Operand number_operand();
  Operand address_operand();
  std::vector<Operand> list_until(std::string_view mark);

  const std::vector<Token> tokens_;
  const std::string file_;
  size_t at_ = 0;
};

}  // namespace glint::frontend::ptx
