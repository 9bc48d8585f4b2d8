// Reads regular files whole.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Return the bytes of a file, or nullopt when it cannot be read. Only a regular file can be read, because
// the reader of a pipe waits for a writer, and a device may have no end.
std::optional<std::string> read_regular_file(const std::string& path);
std::optional<std::vector<unsigned char>> read_regular_bytes(const std::string& path);

// Returns the bytes of a regular file, or 0 when it is none.
uint64_t size_of_regular_file(const std::string& path);

// Fills `out` with the first bytes of a regular file, on up to `threads` threads of the host. Returns false
// when the file cannot be read or has fewer bytes.
bool read_regular_file(const std::string& path, std::span<char> out, uint32_t threads);

}  // namespace glint
