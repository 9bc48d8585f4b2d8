// Finds functions and calls in the text of a shader.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/call_tree.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace glint::report {
namespace {

// Splits a text into words and signs with their lines. Comments and lines of the preprocessor are left out.
class Tokens {
 public:
  explicit Tokens(const std::string& text) : text_(text) {}
  uint32_t line() const { return line_; }

  // Returns the next word or sign, or "" at the end.
  std::string next() {
    skip();
    if (at_ == text_.size()) return "";
    const size_t begin = at_++;
    if (is_word(text_[begin]))
      while (at_ < text_.size() && is_word(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

 private:
  static bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
  bool begins(const char* what) const { return text_.compare(at_, 2, what) == 0; }

  void step() {
    if (text_[at_++] == '\n') {
      ++line_;
      fresh_ = true;
    }
  }
  void skip_line() {
    while (at_ < text_.size() && (text_[at_] != '\n' || text_[at_ - 1] == '\\')) step();
  }
  void skip() {
    while (at_ < text_.size()) {
      if (begins("//") || (fresh_ && text_[at_] == '#')) {
        skip_line();
      } else if (begins("/*")) {
        while (at_ < text_.size() && !begins("*/")) step();
        at_ = std::min(at_ + 2, text_.size());
      } else if (std::isspace(static_cast<unsigned char>(text_[at_]))) {
        step();
      } else {
        fresh_ = false;  // This line has content.
        return;
      }
    }
  }

  const std::string& text_;
  size_t at_ = 0;
  uint32_t line_ = 1;
  bool fresh_ = true;
};

}  // namespace

CallTree::CallTree(const std::vector<std::string>& files, const TextOf& text_of) {
  for (const std::string& file : files)
    if (const std::optional<std::string> text = text_of(file)) scan(file, *text);
}

// Scans a file. A word before parentheses is a function's head when a brace follows them outside of all
// braces, and it may be a call inside of braces.
void CallTree::scan(const std::string& file, const std::string& text) {
  Tokens tokens(text);
  std::string before, head;  // the word before, and the word before the last parentheses outside of braces
  int braces = 0, parens = 0;
  bool in_function = false;
  for (std::string token = tokens.next(); !token.empty(); before = token, token = tokens.next()) {
    if (token == "(") {
      if (in_function)
        calls_[before].push_back({before, file, tokens.line()});
      else if (parens == 0)
        head = before;
      ++parens;
    } else if (token == ")") {
      --parens;
    } else if (token == "{") {
      if (braces++ == 0 && before == ")") {
        in_function = true;
        functions_.push_back({head, file, tokens.line(), tokens.line()});
        ++bodies_[head];
      }
    } else if (token == "}" && --braces == 0 && in_function) {
      in_function = false;
      functions_.back().last = tokens.line();
    }
  }
}

const CallTree::Function* CallTree::around(const std::string& file, uint32_t line) const {
  for (const Function& function : functions_)
    if (function.file == file && function.first <= line && line <= function.last) return &function;
  return nullptr;
}

const CallTree::Call* CallTree::only_call(const std::string& name) const {
  const auto body = bodies_.find(name);
  const auto calls = calls_.find(name);
  if (body == bodies_.end() || body->second != 1 || calls == calls_.end() || calls->second.size() != 1)
    return nullptr;
  return &calls->second.front();
}

std::vector<std::string> frames_of(const ProgramListing& program, uint32_t scope, const std::string& file,
                                   uint32_t line) {
  if (scope == 0 || scope > program.scopes.size()) return {};
  std::vector<std::string> out{fmt::format("{}:{}", file, line)};
  while (scope != 0 && scope <= program.scopes.size()) {
    const ListedScope& row = program.scopes[scope - 1];
    out.insert(out.begin(), row.function);
    if (row.caller != 0)
      out.insert(
          out.begin(),
          fmt::format("{}:{}", row.file < program.files.size() ? program.files[row.file] : "?", row.line));
    scope = row.caller < scope ? row.caller : 0;  // Callers come first.
  }
  return out;
}

std::vector<std::string> CallTree::frames(const std::string& file, uint32_t line) const {
  std::vector<std::string> out{fmt::format("{}:{}", file, line)};
  const Function* function = around(file, line);
  for (size_t depth = 0; function && depth < functions_.size(); ++depth) {
    out.insert(out.begin(), function->name);
    const Call* const call = only_call(function->name);
    if (!call) break;
    const Function* const caller = around(call->file, call->line);
    if (!caller || caller == function) break;
    out.insert(out.begin(), fmt::format("{}:{}", call->file, call->line));
    function = caller;
  }
  return out;
}

}  // namespace glint::report
