// Reads regular files whole.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace glint {

// Return the bytes of a file, or nullopt when it cannot be read. Only a regular file can be read, because
// the reader of a pipe waits for a writer, and a device may have no end.
std::optional<std::string> read_regular_file(const std::string& path);
std::optional<std::vector<unsigned char>> read_regular_bytes(const std::string& path);

}  // namespace glint
