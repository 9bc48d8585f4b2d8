// Declares the five kinds of error and how they travel: wrong user input, an unsupported shader, a fault of
// the simulated program, a stuck machine, and (base/check.h) Glint's own bugs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace glint {

// Names the exit codes of the process (docs/errors.md). Ok means that the run finished; each other code says
// who has to act.
enum class Exit : int { Ok = 0, Failure = 1, UserInput = 2, Unsupported = 3, Fault = 4, Stuck = 5 };

// Names a place in a user's file. Line and column count from 1; 0 means that the number is not known.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
  // Returns "file:line:column" without the parts that are not known, or "" without a file.
  std::string to_string() const;
};

// An error that ends loading or running. It is thrown only between main and the end of loading, or by a run
// loop after the machine has stopped, and never inside the cycle loop.
class Error : public std::runtime_error {
 public:
  Error(Exit exit, const std::string& message) : std::runtime_error(message), exit_(exit) {}
  Exit exit() const { return exit_; }

 private:
  Exit exit_;
};

// Reports bad input. The message is complete: "file:line:col: error: what was found, what was expected\nnote:
// fix".
class UserError : public Error {
 public:
  explicit UserError(const std::string& message) : Error(Exit::UserInput, message) {}
  UserError(const SourceLocation& where, const std::string& what, const std::string& note = {});
};

// Reports valid input that Glint does not support. The message lists everything that is not supported.
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
  void throw_if_errors() const;  // throws a UserError with every message, one per line

 private:
  std::vector<std::string> messages_;
  int num_errors_ = 0;
};

// Returns the candidate nearest to `word` by edit distance, or "" when no candidate is near. Messages use it
// for "did you mean".
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace glint
