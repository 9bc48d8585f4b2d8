// Gives a process the bytes of a file without copying them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

namespace glint {

// Gives pages of memory back to the host.
struct FreePages {
  size_t bytes = 0;
  void operator()(void* pages) const;
};
using Pages = std::unique_ptr<void, FreePages>;

// Returns pages that hold the bytes of a file. What is written there stays in this process. Pages of a file
// on a local disk are those that the host keeps of it, so that a large file takes neither time nor memory
// before it is touched. A file on another file system is read at once: another machine could take it away
// later. The file must not be changed while the pages are in use, but it may be removed. An empty file has
// no pages: they are null. Returns nullopt when the file cannot be read.
std::optional<Pages> pages_of_file(const std::string& path);

}  // namespace glint
