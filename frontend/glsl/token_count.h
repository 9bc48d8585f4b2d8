// Counts the tokens of a shader after its macros are expanded, and finds shaders that have too many.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"

namespace glint::frontend {

// Choice: half a million tokens make more instructions than a program may have after inlining
// (kMostInlined), so that only code that nothing calls would need more. It bounds the time of glslang, and
// the stack on which it recurses.
inline constexpr double kMostTokens = 1 << 19;

// Computes what macros expand to without expanding them: the size of a macro is a constant and a multiple of
// each argument's size, so nested macros cost no more than their text. A name that is defined several times
// counts with its largest definition, and lines that `#if` leaves out count too. A macro that gets its name
// only by the expansion of another one counts as one token.
class TokenCount {
 public:
  struct Header {
    std::string name;
    bool is_local = false;  // #include "name", not <name>
  };
  // Adds a text, which `file` names in messages. Returns the headers that it includes.
  std::vector<Header> add(const std::string& file, std::string_view text);

  // Throws UserError at the macro that expands to most when all texts together have more than kMostTokens
  // tokens.
  void check() const;

 private:
  struct Token {
    std::string_view text;
    int line = 0;
  };
  using Tokens = std::vector<Token>;
  // Is a number of tokens. A double becomes infinite where an integer would overflow.
  struct Size {
    double constant = 0;
    std::vector<double> multiples;  // one for each parameter of the macro around it
    void add(const Size& other, double times);
  };
  struct Definition {
    bool takes_arguments = false;
    std::vector<std::string_view> parameters;
    Tokens body;
  };
  struct Use {  // the lines between two directives
    std::string file;
    Tokens tokens;
  };
  class Sizes;

  void define(const Tokens& directive);

  std::deque<std::string> texts_;  // The tokens point into them.
  std::map<std::string_view, std::vector<Definition>> macros_;
  std::vector<Use> uses_;
};

}  // namespace glint::frontend
