// Locks a file of a folder.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/folder_lock.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "base/diagnostics.h"

namespace glint::report {
namespace {

// Returns whether the open file still has that name, which the holder before may have removed.
bool has_name(int file, const std::string& path) {
  struct stat open {
  }, named{};
  return ::fstat(file, &open) == 0 && ::stat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
         open.st_ino == named.st_ino;
}

}  // namespace

FolderLock::FolderLock(const std::string& folder) : path_(folder + "/" + kLockFile) {
  for (;;) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (file_ < 0)
      throw UserError({path_}, std::string("cannot write the file: ") + std::strerror(errno),
                      "is the disk full, or the folder read-only?");
    const bool is_held = ::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!is_held && has_name(file_, path_)) return;
    ::close(std::exchange(file_, -1));
    if (is_held)
      throw UserError({folder}, "another process writes its results into this folder",
                      "wait until it has ended, or give --out a new or empty folder");
  }
}

FolderLock::~FolderLock() {
  if (file_ < 0) return;
  ::unlink(path_.c_str());  // The file goes while it is locked, so nobody holds a lock on a removed file.
  ::close(file_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {
}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  return *this;
}

bool is_unused_folder(const std::string& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_begun_record = name.starts_with("run.json.") && name.ends_with(".tmp");  // write_file()
    if (name != kLockFile && !is_begun_record) return false;
  }
  return true;
}

}  // namespace glint::report
