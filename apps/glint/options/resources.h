// Finds presets and shaders: beside an installed executable, or in the source tree of a built one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"

namespace glint::app {

class Resources {
 public:
  // Looks relative to the running executable first, then in the source folder that was known at compile time.
  static Resources find();
  explicit Resources(std::string root) : root_(std::move(root)) {}

  // Returns the path for a preset's name ("mobile") or a path to a TOML file. Throws UserError with the
  // nearest name when it is neither.
  std::string config_path(const std::string& name_or_path) const;
  std::vector<std::string> config_names() const;  // sorted
  // The same for the experiments of `glint lab`.
  std::string lab_path(const std::string& name_or_path) const;
  std::vector<std::string> lab_names() const;  // sorted

  // Returns the folder of a built-in shader set; `folder` is its name in shaders/.
  std::string shader_dir(const std::string& folder) const { return root_ + "/shaders/" + folder; }
  // Returns the path of a part of the HTML report, as web/ builds it.
  std::string web_file(const std::string& name) const { return root_ + "/web/dist/" + name; }

 private:
  std::string root_;
};

// Returns the whole file as bytes. Throws UserError when it cannot be read.
std::string read_file(const std::string& path);
// Returns the same, but nothing where the file cannot be read.
std::optional<std::string> text_of_file(const std::string& path);

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
