// Reads the bytes of a regular file.
// SPDX-License-Identifier: Apache-2.0
#include "base/regular_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace glint {

std::optional<std::string> read_regular_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

}  // namespace glint
