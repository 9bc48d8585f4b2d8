// Writes what the command was asked for to files or to standard output.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <string>
#include <utility>

#include "base/diagnostics.h"

namespace glint::app {

// Is thrown when standard output takes no more: the disk is full, or the descriptor is closed.
class OutputError : public Error {
 public:
  OutputError() : Error(Exit::Failure, "cannot write to standard output") {}
};

// Writes to `path` (report::write_file()), or to stdout when `path` is empty or "-". All output to stdout
// goes this way, so that no loss goes unnoticed. Throws UserError when the file cannot be written, and
// OutputError when stdout cannot.
void write_output(const std::string& path, const std::string& bytes);

// Prints to stdout as fmt::print() does.
template <class... Args>
void print_output(fmt::format_string<Args...> text, Args&&... args) {
  write_output("", fmt::format(text, std::forward<Args>(args)...));
}

}  // namespace glint::app
