// Which calls a source line stands under: functions and their calls, as the text of GLSL files shows them.
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

// The compiler inlines every function, and the instructions keep the line of the function's body alone. Who
// called follows from the text, where it can be one place only: a function that is called from several lines,
// has overloads or calls itself begins a stack. Model: calls in macros are not seen.
class CallTree {
 public:
  // The text of a file; nothing when it cannot be read.
  using TextOf = std::function<std::optional<std::string>(const std::string& file)>;

  // Of the files that make up one shader.
  CallTree(const std::vector<std::string>& files, const TextOf& text_of);

  // Outermost first, function and line in turn: {"main", "a.rgen:40", "shade", "b.glsl:17"}. Of lines outside
  // of all known functions the line alone.
  std::vector<std::string> frames(const std::string& file, uint32_t line) const;

 private:
  struct Function {
    std::string name, file;
    uint32_t first = 0, last = 0;  // lines of its body, the braces' included
  };
  struct Call {
    std::string name, file;
    uint32_t line = 0;
  };
  void scan(const std::string& file, const std::string& text);
  const Function* around(const std::string& file, uint32_t line) const;
  // The only call of a function that has one body; null when there are several, or none.
  const Call* only_call(const std::string& name) const;

  std::vector<Function> functions_;
  std::map<std::string, int> bodies_;
  std::map<std::string, std::vector<Call>> calls_;
};

// The frames of a line in scope `scope` of a program whose compiler kept its calls: as CallTree::frames(),
// for every chain of calls by itself. Empty when the scope is unknown.
std::vector<std::string> frames_of(const ProgramListing& program, uint32_t scope, const std::string& file,
                                   uint32_t line);

}  // namespace glint::report
