// Finds presets and shaders: beside an installed program or library, or in the source tree of a built one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glint::setup {

class Resources {
 public:
  // Looks from the folder of `binary` upwards first, for share/glint or a source tree, and then in the source
  // folder that was known at compile time.
  static Resources find(const std::string& binary);
  // Does so from the running executable.
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
  // Returns the folder that the Python package lies in, in a source tree or below the prefix of an
  // installation, or "" where it is in neither.
  std::string python_dir() const;
  // Returns the path of a part of the HTML report, as web/ builds it.
  std::string web_file(const std::string& name) const { return root_ + "/web/dist/" + name; }

 private:
  std::string root_;
};

// Returns the whole file as bytes. Throws UserError when it cannot be read.
std::string read_file(const std::string& path);
// Returns the same, but nothing where the file cannot be read.
std::optional<std::string> text_of_file(const std::string& path);

}  // namespace glint::setup
