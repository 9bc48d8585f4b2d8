// Finds the calls that lead to a source line, from functions and calls in the text of GLSL files.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/program_listing.h"

namespace glint::report {

// Knows who calls whom. The compiler inlines every function, and the instructions keep only the line of the
// function's body. The text tells the caller when it can be only one place. A function that is called from
// several lines, has overloads or calls itself begins a stack. Model: calls in macros are not seen.
class CallTree {
 public:
  // Returns the text of a file, or nothing when it cannot be read.
  using TextOf = std::function<std::optional<std::string>(const std::string& file)>;

  // Reads the files that make up one shader.
  CallTree(const std::vector<std::string>& files, const TextOf& text_of);

  // Returns the frames of a line, the outermost first, function and line in turn: {"main", "a.rgen:40",
  // "shade", "b.glsl:17"}. For lines outside of all known functions it returns only the line.
  std::vector<std::string> frames(const std::string& file, uint32_t line) const;

 private:
  struct Function {
    std::string name, file;
    uint32_t first = 0, last = 0;  // lines of its body, including those of the braces
  };
  struct Call {
    std::string name, file;
    uint32_t line = 0;
  };
  void scan(const std::string& file, const std::string& text);
  const Function* around(const std::string& file, uint32_t line) const;
  // Returns the only call of a function that has one body, or null when there are several calls, or none.
  const Call* only_call(const std::string& name) const;

  std::vector<Function> functions_;
  std::map<std::string, int> bodies_;
  std::map<std::string, std::vector<Call>> calls_;
};

// Returns the frames of a line in scope `scope` of a program whose compiler kept its calls. The form is that
// of CallTree::frames(), with every chain of calls by itself. The result is empty when the scope is unknown.
std::vector<std::string> frames_of(const ProgramListing& program, uint32_t scope, const std::string& file,
                                   uint32_t line);

}  // namespace glint::report
