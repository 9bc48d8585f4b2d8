// Reads constant expressions and operands.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "frontend/ptx/parser.h"

namespace glint::frontend::ptx {

void Cursor::fail(TextPosition at, const std::string& message) const {
  throw UserError({file_, at.line, at.column}, message);
}

void Cursor::fail(const std::string& expected) const {
  const Token& t = peek();
  const std::string found = t.kind == Token::Kind::End       ? "the end of the file"
                            : t.kind == Token::Kind::DotWord ? fmt::format("'.{}'", t.text)
                                                             : fmt::format("'{}'", t.text);
  fail(t.position, fmt::format("expected {}, found {}", expected, found));
}

bool Cursor::accept(std::string_view mark) {
  if (!is_mark(mark)) return false;
  next();
  return true;
}

bool Cursor::accept_dot(std::string_view word) {
  if (!is_dot(word)) return false;
  next();
  return true;
}

void Cursor::expect(std::string_view mark) {
  if (!accept(mark)) fail(fmt::format("'{}'", mark));
}

std::string Cursor::expect_word(const std::string& what) {
  if (!is(Token::Kind::Word)) fail(what);
  return next().text;
}

namespace {

// Returns the binding strength of an operator of constant expressions, or 0 when there is no such operator.
int strength_of(const std::string& mark) {
  static constexpr std::pair<std::string_view, int> kStrength[] = {
      {"||", 1}, {"&&", 2}, {"|", 3},  {"^", 4},  {"&", 5}, {"==", 6}, {"!=", 6}, {"<", 7},  {">", 7},
      {"<=", 7}, {">=", 7}, {"<<", 8}, {">>", 8}, {"+", 9}, {"-", 9},  {"*", 10}, {"/", 10}, {"%", 10}};
  for (const auto& [text, strength] : kStrength)
    if (text == mark) return strength;
  return 0;
}

// Choice: constant expressions use 64-bit two's complement. Division and comparison are signed, as for
// literals without a U.
uint64_t apply(const std::string& op, uint64_t a, uint64_t b) {
  const int64_t x = int64_t(a), y = int64_t(b);
  if (op == "+") return a + b;
  if (op == "-") return a - b;
  if (op == "*") return a * b;
  if (op == "/") return y == -1 ? 0 - a : uint64_t(x / y);
  if (op == "%") return y == -1 ? 0 : uint64_t(x % y);
  if (op == "<<") return b < 64 ? a << b : 0;
  if (op == ">>") return uint64_t(x >> (b < 64 ? b : 63));
  if (op == "&") return a & b;
  if (op == "|") return a | b;
  if (op == "^") return a ^ b;
  if (op == "==") return a == b;
  if (op == "!=") return a != b;
  if (op == "<") return x < y;
  if (op == ">") return x > y;
  if (op == "<=") return x <= y;
  if (op == ">=") return x >= y;
  return op == "&&" ? a && b : a || b;
}

}  // namespace

uint64_t Cursor::binary(int least, const std::string& what) {
  uint64_t left = unary(what);
  while (is(Token::Kind::Mark)) {
    const Token op = peek();
    const int strength = strength_of(op.text);
    if (strength == 0 || strength <= least) break;
    next();
    const uint64_t right = binary(strength, what);
    if (right == 0 && (op.text == "/" || op.text == "%"))
      fail(op.position, "division by zero in a constant expression");
    left = apply(op.text, left, right);
  }
  return left;
}

uint64_t Cursor::unary(const std::string& what) {
  if (accept("-")) return 0 - unary(what);
  if (accept("+")) return unary(what);
  if (accept("~")) return ~unary(what);
  if (accept("!")) return !unary(what);
  if (accept("(")) {
    const uint64_t value = constant(what);
    expect(")");
    return value;
  }
  if (is(Token::Kind::Word) && peek().text == "WARP_SZ") {
    next();
    return 32;
  }
  if (!is(Token::Kind::Integer)) fail(what);
  return next().value;
}

Operand Cursor::operand() {
  Operand first = simple_operand();
  if (!is_mark("|")) return first;
  Operand pair;
  pair.kind = Operand::Kind::Pair;
  pair.position = first.position;
  pair.parts.push_back(std::move(first));
  while (accept("|")) pair.parts.push_back(simple_operand());
  return pair;
}

std::vector<Operand> Cursor::list_until(std::string_view mark) {
  std::vector<Operand> list;
  while (!accept(mark)) {
    if (!list.empty()) expect(",");
    list.push_back(operand());
  }
  return list;
}

Operand Cursor::simple_operand() {
  Operand out;
  out.position = peek().position;
  if (is_mark("{") || is_mark("(")) {
    out.kind = is_mark("{") ? Operand::Kind::Vector : Operand::Kind::List;
    next();
    out.parts = list_until(out.kind == Operand::Kind::Vector ? "}" : ")");
    return out;
  }
  if (is_mark("[")) return address_operand();
  const bool is_not = is_mark("!");
  if (is_not && peek(1).kind == Token::Kind::Word) {
    next();
    out.negated = true;
  }
  if (!is(Token::Kind::Word) || peek().text == "WARP_SZ") return number_operand();
  out.kind = peek().text == "_" ? Operand::Kind::Sink : Operand::Kind::Name;
  out.name = next().text;
  if (is(Token::Kind::DotWord)) out.element = next().text;
  if (is_mark("+") || is_mark("-")) out.offset = int64_t(binary(0, "a displacement"));
  return out;
}

Operand Cursor::number_operand() {
  Operand out;
  out.position = peek().position;
  const bool negative =
      is_mark("-") && (peek(1).kind == Token::Kind::Float32 || peek(1).kind == Token::Kind::Float64);
  if (negative) next();
  if (is(Token::Kind::Float32) || is(Token::Kind::Float64)) {
    const bool single = is(Token::Kind::Float32);
    out.kind = single ? Operand::Kind::Float32 : Operand::Kind::Float64;
    out.value = next().value ^ (negative ? uint64_t{1} << (single ? 31 : 63) : 0);
    return out;
  }
  out.kind = Operand::Kind::Integer;
  // No operand of PTX has `|` after a number, so a constant expression may use it here.
  out.value = constant("an operand");
  return out;
}

Operand Cursor::address_operand() {
  Operand out;
  out.kind = Operand::Kind::Address;
  out.position = peek().position;
  expect("[");
  out.parts = list_until("]");
  if (out.parts.empty()) fail(out.position, "an address needs a base");
  Operand& base = out.parts.front();
  out.offset = std::exchange(base.offset, 0);
  return out;
}

}  // namespace glint::frontend::ptx
