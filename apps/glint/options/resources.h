// Where presets and shaders lie: beside an installed executable, or in the source tree of a built one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"

namespace glint::app {

class Resources {
 public:
  // Looks relative to the running executable first, then in the source folder known when it was compiled.
  static Resources find();
  explicit Resources(std::string root) : root_(std::move(root)) {}

  // A preset's name ("mobile") or a path to a TOML file. UserError with the nearest name when neither.
  std::string config_path(const std::string& name_or_path) const;
  std::vector<std::string> config_names() const;  // sorted

  // The folder of a built-in shader set; `folder` as in shaders/.
  std::string shader_dir(const std::string& folder) const { return root_ + "/shaders/" + folder; }
  // A part of the HTML report, as web/ builds it.
  std::string web_file(const std::string& name) const { return root_ + "/web/dist/" + name; }

 private:
  std::string root_;
};

// Whole file as bytes. UserError when it cannot be read.
std::string read_file(const std::string& path);
// Standard output that takes no more: a full disk, a closed descriptor.
class OutputError : public Error {
 public:
  OutputError() : Error(Exit::Failure, "cannot write to standard output") {}
};

// Writes to `path` (report::write_file()), or to stdout when it is empty or "-": the one way to it, so that
// no loss goes unnoticed. UserError when the file cannot be written, OutputError when stdout cannot.
void write_output(const std::string& path, const std::string& bytes);

// To stdout, as fmt::print().
template <class... Args>
void print_output(fmt::format_string<Args...> text, Args&&... args) {
  write_output("", fmt::format(text, std::forward<Args>(args)...));
}

}  // namespace glint::app
