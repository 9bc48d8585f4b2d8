// Finds and reads files.
// SPDX-License-Identifier: Apache-2.0
#include "setup/resources.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"

namespace glint::setup {
namespace fs = std::filesystem;
namespace {

bool is_root(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path / "configs/mobile.toml", ignored) &&
         fs::is_directory(path / "shaders", ignored);
}

// Returns the names of the TOML files in a folder, sorted.
std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

// Returns the path of a file of the folder by its name, or of a user's file. `what` and `kind` describe both
// in the message when there is neither.
std::string path_in(const std::string& folder, const std::string& name_or_path, std::string_view what,
                    std::string_view kind) {
  const std::vector<std::string> names = names_in(folder);
  if (std::find(names.begin(), names.end(), name_or_path) != names.end())
    return folder + "/" + name_or_path + ".toml";
  std::error_code error;
  if (fs::is_regular_file(name_or_path, error)) return name_or_path;
  const std::string guess = nearest(name_or_path, names);
  throw UserError({},
                  fmt::format("there is no {} '{}': neither {} ({}) nor a file", what, name_or_path, kind,
                              fmt::join(names, ", ")),
                  guess.empty() ? "" : fmt::format("did you mean '{}'?", guess));
}

}  // namespace

Resources Resources::find(const std::string& binary) {
  std::error_code error;
  const fs::path folder = fs::absolute(binary, error).parent_path();
  for (fs::path path = folder; path.has_relative_path(); path = path.parent_path())
    for (const fs::path& root : {path / "share/glint", path})
      if (is_root(root)) return Resources(root.string());
  return Resources(GLINT_SOURCE_DIR);
}

Resources Resources::find() {
  std::error_code error;
  return find(fs::read_symlink("/proc/self/exe", error).string());
}

std::vector<std::string> Resources::config_names() const {
  return names_in(root_ + "/configs");
}

std::string Resources::config_path(const std::string& name_or_path) const {
  return path_in(root_ + "/configs", name_or_path, "configuration", "a preset");
}

std::vector<std::string> Resources::lab_names() const {
  return names_in(root_ + "/labs");
}

std::string Resources::lab_path(const std::string& name_or_path) const {
  return path_in(root_ + "/labs", name_or_path, "experiment", "one of Glint's");
}

std::string Resources::python_dir() const {
  std::error_code ignored;
  std::vector<fs::path> places = {fs::path(root_) / "python"};
  for (const auto& entry : fs::directory_iterator(fs::path(root_) / "../../lib", ignored))
    if (entry.path().filename().string().starts_with("python3"))
      places.push_back(entry.path() / "dist-packages");
  for (const fs::path& place : places)
    if (fs::is_regular_file(place / "glint/__init__.py", ignored)) return place.lexically_normal().string();
  return "";
}

std::string read_file(const std::string& path) {
  std::error_code error;
  std::optional<std::string> text = text_of_file(path);
  if (!text || fs::is_directory(path, error)) throw UserError({path}, "cannot read the file");
  return std::move(*text);
}

std::optional<std::string> text_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  std::ostringstream out;
  out << in.rdbuf();  // in blocks; a file of /proc does not say how long it is
  return std::move(out).str();
}

}  // namespace glint::setup
