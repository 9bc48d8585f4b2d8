// Maps files that lie on local disks, and reads others.
// SPDX-License-Identifier: Apache-2.0
#include "base/file_pages.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fcntl.h>
#include <linux/magic.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

namespace glint {
namespace {

// Holds a file descriptor.
class OpenFile {
 public:
  // O_NONBLOCK does not wait for the writer of a pipe, and changes nothing for a regular file.
  explicit OpenFile(const std::string& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  // Returns the bytes of a regular file, or nullopt for anything else.
  std::optional<size_t> size() const {
    struct stat status {};
    const bool is_regular = descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
    return is_regular ? std::optional(size_t(status.st_size)) : std::nullopt;
  }

  // Says whether the host alone decides when the file's bytes go away.
  bool is_local() const {
    constexpr long kXfs = 0x58465342;  // linux/magic.h leaves this one out.
    constexpr std::array<long, 7> kLocal{EXT4_SUPER_MAGIC,
                                         BTRFS_SUPER_MAGIC,
                                         F2FS_SUPER_MAGIC,
                                         TMPFS_MAGIC,
                                         OVERLAYFS_SUPER_MAGIC,
                                         RAMFS_MAGIC,
                                         kXfs};
    struct statfs system {};
    return ::fstatfs(descriptor_, &system) == 0 &&
           std::count(kLocal.begin(), kLocal.end(), long(system.f_type));
  }

  // Maps the file, or fresh memory. Returns null when the host has none.
  Pages map(size_t bytes, bool is_file) const {
    void* const pages =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, is_file ? MAP_PRIVATE : MAP_PRIVATE | MAP_ANONYMOUS,
               is_file ? descriptor_ : -1, 0);
    return pages == MAP_FAILED ? Pages() : Pages(pages, FreePages{bytes});
  }

  // Reads the first bytes of the file. Returns false when it has fewer.
  bool read(void* out, size_t bytes) const {
    auto* at = static_cast<char*>(out);
    for (ssize_t got = 1; bytes > 0 && got > 0; bytes -= size_t(got), at += got)
      got = ::read(descriptor_, at, bytes);
    return bytes == 0;
  }

 private:
  const int descriptor_;
};

}  // namespace

void FreePages::operator()(void* pages) const {
  ::munmap(pages, bytes);
}

std::optional<Pages> pages_of_file(const std::string& path) {
  const OpenFile file(path);
  const std::optional<size_t> bytes = file.size();
  if (!bytes) return std::nullopt;
  if (*bytes == 0) return Pages();
  const bool is_local = file.is_local();
  Pages pages = file.map(*bytes, is_local);
  if (!pages || (!is_local && !file.read(pages.get(), *bytes))) return std::nullopt;
  return pages;
}

}  // namespace glint
