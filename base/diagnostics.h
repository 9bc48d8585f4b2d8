// The five kinds of error and how they travel: user input, unsupported shader, fault of the simulated
// program, stuck machine, and (base/check.h) our own bugs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace glint {

// Process exit codes (docs/errors.md). Ok = finished; the others say whose move it is.
enum class Exit : int { Ok = 0, Failure = 1, UserInput = 2, Unsupported = 3, Fault = 4, Stuck = 5 };

// A place in a user's file. Line and column count from 1; 0 means "not known".
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
  std::string to_string() const;  // "file:line:column", leaving out what is not known; "" without a file
};

// An error that ends loading or running. Thrown only between main and the end of loading, or by a run
// loop after the machine has stopped; never inside the cycle loop.
class Error : public std::runtime_error {
 public:
  Error(Exit exit, const std::string& message) : std::runtime_error(message), exit_(exit) {}
  Exit exit() const { return exit_; }

 private:
  Exit exit_;
};

// Bad input. The message is complete: "file:line:col: error: what was found, what was expected\nnote: fix".
class UserError : public Error {
 public:
  explicit UserError(const std::string& message) : Error(Exit::UserInput, message) {}
  UserError(const SourceLocation& where, const std::string& what, const std::string& note = {});
};

// Valid input that Glint does not support (yet); the message lists all of it.
class UnsupportedError : public Error {
 public:
  explicit UnsupportedError(const std::string& message) : Error(Exit::Unsupported, message) {}
};

// Collects every error of a loading step, so that a user sees them all at once.
class Diagnostics {
 public:
  void error(const SourceLocation& where, const std::string& what, const std::string& note = {});
  void warning(const SourceLocation& where, const std::string& what);
  bool has_errors() const { return num_errors_ > 0; }
  const std::vector<std::string>& messages() const { return messages_; }
  void throw_if_errors() const;  // UserError with every message, one a line

 private:
  std::vector<std::string> messages_;
  int num_errors_ = 0;
};

// The candidate nearest to `word` by edit distance, or "" when none is near: for "did you mean".
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace glint
